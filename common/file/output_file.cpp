// SPDX-License-Identifier: Apache-2.0
#include "common/file/output_file.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <stdexcept>
#include <unistd.h>

namespace sidestep {

void throw_unwritable(const std::string& path, const std::string& reason) {
  throw std::runtime_error(fmt::format("cannot write {}: {}", path, reason));
}

OutputFile open_output(const std::string& path, WriteMode mode) {
  const bool appends = mode == WriteMode::kAppend;
  const int descriptor =
      open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NONBLOCK | (appends ? O_APPEND : O_TRUNC), 0666);
  if (descriptor < 0) {
    const int problem = errno;
    std::error_code error;
    const bool lacks_reader = problem == ENXIO && std::filesystem::is_fifo(path, error);
    throw_unwritable(path, lacks_reader ? "no process reads this pipe" : std::strerror(problem));
  }
  fcntl(descriptor, F_SETFL, fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);  // writing may block
  OutputFile file(fdopen(descriptor, appends ? "a" : "w"));
  if (file) return file;
  const std::string reason = std::strerror(errno);
  close(descriptor);
  throw_unwritable(path, reason);
}

}  // namespace sidestep
