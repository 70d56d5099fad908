// SPDX-License-Identifier: Apache-2.0
#include "common/file/permission.hpp"

#include <array>
#include <cerrno>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <pwd.h>
#include <stdexcept>
#include <sys/stat.h>
#include <unistd.h>

namespace sidestep {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxLinks = 40;  ///< the kernel follows at most this many

std::string user_name(uid_t user) {
  passwd entry{};
  passwd* found = nullptr;
  std::array<char, 4096> text{};
  if (getpwuid_r(user, &entry, text.data(), text.size(), &found) == 0 && found != nullptr)
    return entry.pw_name;
  return fmt::format("{}", user);
}

bool is_denied(const fs::path& path, int access) {
  return faccessat(AT_FDCWD, path.c_str(), access, AT_EACCESS) != 0 && errno == EACCES;
}

std::optional<struct stat> status_of(const fs::path& path) {
  struct stat status {};
  return stat(path.c_str(), &status) == 0 ? std::optional(status) : std::nullopt;
}

/// The permission needed for a part of a path: folders before the last part must be searchable. The last part
/// must allow `access` (R_OK or W_OK) and, if it is a folder, be searchable.
int needed_access(const fs::path& part, const fs::path& path, int access) {
  const auto status = status_of(part);
  const bool is_folder = status && S_ISDIR(status->st_mode);
  if (part != path) return X_OK;
  return is_folder ? access | X_OK : access;
}

/// The file or folder whose permissions prevent the user from accessing an absolute path.
fs::path inaccessible_part(const fs::path& path, int access, int links = 0) {
  fs::path part;
  for (const fs::path& name : path) {
    part /= name;
    if (!is_denied(part, needed_access(part, path, access))) continue;
    std::error_code none;
    if (status_of(part) || links == kMaxLinks || !fs::is_symlink(fs::symlink_status(part, none))) return part;
    const fs::path target = part.parent_path() / fs::read_symlink(part, none);
    return inaccessible_part(target.lexically_normal(), access, links + 1);
  }
  return path;
}

std::optional<std::string> denied_access(const fs::path& absolute, int access) {
  if (!is_denied(absolute, needed_access(absolute, absolute, access))) return std::nullopt;
  const fs::path closed = inaccessible_part(absolute, access);
  std::string reason = "permission denied at " + closed.string();
  if (const auto status = status_of(closed))
    reason = fmt::format("{} belongs to {} and has mode {:04o}", closed.string(), user_name(status->st_uid),
                         status->st_mode & 07777);
  return fmt::format("user {} may not {} {}: {}", user_name(geteuid()), access == R_OK ? "read" : "write",
                     absolute.string(), reason);
}

}  // namespace

std::optional<std::string> denied_read(const std::string& path) {
  return denied_access(fs::absolute(path).lexically_normal(), R_OK);
}

std::optional<std::string> denied_write(const std::string& path) {
  fs::path target = fs::absolute(path).lexically_normal();
  std::error_code none;
  while (!fs::exists(target, none) && target.has_relative_path()) target = target.parent_path();
  return denied_access(target, W_OK);
}

void require_read_permission(const std::string& path) {
  if (const auto problem = denied_read(path)) throw std::invalid_argument(*problem);
}

}  // namespace sidestep
