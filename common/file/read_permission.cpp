// SPDX-License-Identifier: Apache-2.0
#include "common/file/read_permission.hpp"

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

/// The permission needed for a part of a path: folders before the last part must be searchable, and the last
/// part must be readable and, if it is a folder, searchable.
int needed_access(const fs::path& part, const fs::path& path) {
  const auto status = status_of(part);
  const bool is_folder = status && S_ISDIR(status->st_mode);
  if (part != path) return X_OK;
  return is_folder ? R_OK | X_OK : R_OK;
}

/// The file or folder whose permissions prevent the user from reading an absolute path.
fs::path inaccessible_part(const fs::path& path, int links = 0) {
  fs::path part;
  for (const fs::path& name : path) {
    part /= name;
    if (!is_denied(part, needed_access(part, path))) continue;
    std::error_code none;
    if (status_of(part) || links == kMaxLinks || !fs::is_symlink(fs::symlink_status(part, none))) return part;
    const fs::path target = part.parent_path() / fs::read_symlink(part, none);
    return inaccessible_part(target.lexically_normal(), links + 1);
  }
  return path;
}

}  // namespace

std::optional<std::string> denied_read(const std::string& path) {
  const fs::path absolute = fs::absolute(path).lexically_normal();
  if (!is_denied(absolute, needed_access(absolute, absolute))) return std::nullopt;
  const fs::path closed = inaccessible_part(absolute);
  std::string reason = "permission denied at " + closed.string();
  if (const auto status = status_of(closed))
    reason = fmt::format("{} belongs to {} and has mode {:04o}", closed.string(), user_name(status->st_uid),
                         status->st_mode & 07777);
  return fmt::format("user {} may not read {}: {}", user_name(geteuid()), absolute.string(), reason);
}

void require_read_permission(const std::string& path) {
  if (const auto problem = denied_read(path)) throw std::invalid_argument(*problem);
}

}  // namespace sidestep
