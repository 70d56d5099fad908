// SPDX-License-Identifier: Apache-2.0
#include "common/file/write_file.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <unistd.h>

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

}  // namespace

void write_file(const std::string& path, const std::string& text) {
  std::error_code error;
  if (const auto folder = std::filesystem::path(path).parent_path(); !folder.empty())
    std::filesystem::create_directories(folder, error);
  const auto type = std::filesystem::symlink_status(path, error).type();
  if (type != std::filesystem::file_type::regular && type != std::filesystem::file_type::not_found) {
    if (!write(open_output(path), text)) throw_unwritable(path, std::strerror(errno));
    return;
  }
  const std::string temporary = fmt::format("{}.{}.tmp", path, getpid());
  if (!write(OutputFile(std::fopen(temporary.c_str(), "we")), text)) {
    const std::string reason = std::strerror(errno);
    std::filesystem::remove(temporary, error);
    throw_unwritable(path, reason);
  }
  std::filesystem::rename(temporary, path, error);
  if (!error) return;
  const std::string reason = error.message();
  std::filesystem::remove(temporary, error);
  throw_unwritable(path, reason);
}

}  // namespace sidestep
