// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdlib>
#include <functional>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace sidestep {

/// Runs `work` in a process of its own, which it may change, and returns its text.
inline std::string forked(const std::function<std::string()>& work) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return "cannot create a pipe";
  const pid_t process = fork();
  if (process == 0) {
    const std::string text = work();
    (void)!write(ends[1], text.data(), text.size());
    std::_Exit(0);
  }
  close(ends[1]);
  std::string result;
  std::array<char, 4096> buffer{};
  for (ssize_t got = 0; (got = read(ends[0], buffer.data(), buffer.size())) > 0;)
    result.append(buffer.data(), static_cast<std::size_t>(got));
  close(ends[0]);
  waitpid(process, nullptr, 0);
  return result;
}

}  // namespace sidestep
