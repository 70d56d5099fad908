// SPDX-License-Identifier: Apache-2.0
#include "common/file/write_file.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <stdexcept>
#include <unistd.h>

namespace sidestep {
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& reason) {
  throw std::runtime_error(fmt::format("cannot write {}: {}", path, reason));
}

/// False, with errno set, if the text could not be written completely.
bool write(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  return static_cast<bool>(file);
}

/// Opening a pipe for writing would wait for a reader, and a process that handles a signal is not ended by
/// it.
void require_reader(const std::string& pipe) {
  const int descriptor = open(pipe.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) fail(pipe, errno == ENXIO ? "nobody reads this pipe" : std::strerror(errno));
  close(descriptor);
}

}  // namespace

void write_file(const std::string& path, const std::string& text) {
  std::error_code error;
  if (const auto folder = std::filesystem::path(path).parent_path(); !folder.empty())
    std::filesystem::create_directories(folder, error);
  const auto type = std::filesystem::symlink_status(path, error).type();
  if (std::filesystem::is_fifo(path, error)) require_reader(path);
  if (type != std::filesystem::file_type::regular && type != std::filesystem::file_type::not_found) {
    if (!write(path, text)) fail(path, std::strerror(errno));
    return;
  }
  const std::string temporary = fmt::format("{}.{}.tmp", path, getpid());
  if (!write(temporary, text)) {
    const std::string reason = std::strerror(errno);
    std::filesystem::remove(temporary, error);
    fail(path, reason);
  }
  std::filesystem::rename(temporary, path, error);
  if (!error) return;
  const std::string reason = error.message();
  std::filesystem::remove(temporary, error);
  fail(path, reason);
}

}  // namespace sidestep
