// SPDX-License-Identifier: Apache-2.0
#include "common/file/write_file.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <stdexcept>
#include <unistd.h>

#include "common/file/folder.hpp"
#include "common/file/output_file.hpp"

namespace sidestep {
namespace {

/// Writes the text and closes the file. False, with errno set, if the file is not open or writing failed.
bool write(OutputFile file, const std::string& text) {
  if (!file) return false;
  const bool is_written = std::fwrite(text.data(), 1, text.size(), file.get()) == text.size();
  const int problem = errno;
  if (std::fclose(file.release()) != 0) return false;
  errno = problem;
  return is_written;
}

/// Writes the text to a temporary file beside the path, and returns its name. Throws if that is impossible.
std::string write_beside(const std::string& path, const std::string& text) {
  const std::string temporary = fmt::format("{}.{}.tmp", path, getpid());
  if (write(OutputFile(std::fopen(temporary.c_str(), "we")), text)) return temporary;
  const std::string reason = write_problem(temporary, errno);
  std::error_code error;
  std::filesystem::remove(temporary, error);
  throw_unwritable(path, reason);
}

std::filesystem::file_type type_of(const std::string& path) {
  std::error_code error;
  return std::filesystem::symlink_status(path, error).type();
}

/// Throws unless a file or device exists that the user may write, or nothing exists. Does not open it, which
/// would end the work of a process that reads a pipe.
void require_write_permission(const std::string& path) {
  std::error_code none;
  if (std::filesystem::is_directory(path, none)) throw_unwritable(path, std::strerror(EISDIR));
  const bool is_denied = faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0 && errno != ENOENT;
  if (is_denied) throw_unwritable(path, write_problem(path, errno));
}

/// Throws unless a file can be created beside the path and a byte written to it.
void require_room_beside(const std::string& path) {
  std::error_code error;
  std::filesystem::remove(write_beside(path, " "), error);
}

}  // namespace

void write_file(const std::string& path, const std::string& text) {
  create_folder_of(path);
  const auto type = type_of(path);
  if (type != std::filesystem::file_type::regular && type != std::filesystem::file_type::not_found) {
    if (!write(open_output(path), text)) throw_unwritable(path, std::strerror(errno));
    return;
  }
  const std::string temporary = write_beside(path, text);
  std::error_code error, none;
  std::filesystem::rename(temporary, path, error);
  if (!error) return;
  std::filesystem::remove(temporary, none);
  throw_unwritable(path, error.message());
}

std::string try_write_file(const std::string& path, const std::string& text) try {
  write_file(path, text);
  return "";
} catch (const std::runtime_error& error) {
  return error.what();
}

void require_written(std::initializer_list<std::string> problems) {
  std::string all;
  for (const std::string& problem : problems) all += (all.empty() || problem.empty() ? "" : "; ") + problem;
  if (!all.empty()) throw std::runtime_error(all);
}

void require_replaceable(const std::string& path) {
  create_folder_of(path);
  require_write_permission(path);
  const auto type = type_of(path);
  if (type == std::filesystem::file_type::regular || type == std::filesystem::file_type::not_found)
    require_room_beside(path);
}

void require_openable(const std::string& path) {
  require_write_permission(path);
  const auto type = type_of(path);
  std::error_code none;
  // To empty a file makes room, unless it is empty.
  const bool is_empty =
      type == std::filesystem::file_type::regular && std::filesystem::file_size(path, none) == 0;
  if (is_empty || type == std::filesystem::file_type::not_found) require_room_beside(path);
}

}  // namespace sidestep
