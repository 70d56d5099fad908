// SPDX-License-Identifier: Apache-2.0
#include "common/file/console.hpp"

#include <cerrno>
#include <fcntl.h>
#include <unistd.h>

namespace sidestep {

void write_text(std::FILE* stream, const std::string& text) noexcept {
  (void)!std::fwrite(text.data(), 1, text.size(), stream);
  std::fflush(stream);
}

void reopen_standard_streams() noexcept {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(descriptor, F_GETFD) >= 0 || errno != EBADF) continue;
    // open() returns the lowest free descriptor, which is this one, because the lower ones are open.
    (void)!open("/dev/null", O_RDWR);
  }
}

}  // namespace sidestep
