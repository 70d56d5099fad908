// SPDX-License-Identifier: Apache-2.0
#include "common/file/console.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <stdexcept>
#include <stdio_ext.h>
#include <unistd.h>

namespace sidestep {
namespace {

std::string output_problem(int error) {
  if (error == EBADF) return "it is closed";
  if (error == EPIPE) return "the process that read it has ended";
  return std::strerror(error);
}

}  // namespace

int write_text(std::FILE* stream, const std::string& text) noexcept {
  const bool is_written =
      std::fwrite(text.data(), 1, text.size(), stream) == text.size() && std::fflush(stream) == 0;
  if (is_written) return 0;
  const int error = errno;
  // The library keeps the text, and would write it before the next one.
  __fpurge(stream);
  std::clearerr(stream);
  return error;
}

void write_output(const std::string& text) { require_printed(write_text(stdout, text)); }

void require_printed(int error) {
  if (error != 0) throw std::runtime_error("cannot write to standard output: " + output_problem(error));
}

void finish_output() {
  if (std::fflush(stdout) != 0) require_printed(errno);
  if (std::ferror(stdout) != 0) require_printed(EIO);
}

bool is_output_abandoned() {
  pollfd output{STDOUT_FILENO, 0, 0};
  return poll(&output, 1, 0) == 1 && (output.revents & (POLLERR | POLLHUP)) != 0;
}

void reopen_standard_streams() noexcept {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(descriptor, F_GETFD) >= 0 || errno != EBADF) continue;
    // open() returns the lowest free descriptor, which is this one, because the lower ones are open.
    (void)!open("/dev/null", descriptor == STDOUT_FILENO ? O_RDONLY : O_RDWR);
  }
}

}  // namespace sidestep
