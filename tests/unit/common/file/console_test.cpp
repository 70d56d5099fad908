// SPDX-License-Identifier: Apache-2.0
#include "common/file/console.hpp"

#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/catch.hpp"

namespace sidestep {
namespace {

/// Runs the function in a separate process and returns its exit code; -1 if the process died.
template <typename Work>
int exit_code_of(Work work) {
  const pid_t pid = fork();
  if (pid == 0) _exit(work());
  int status = 0;
  return waitpid(pid, &status, 0) == pid && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

TEST_CASE("output to a full disk or a pipe without a reader is lost without other effects") {
  const int code = exit_code_of([] {
    std::signal(SIGPIPE, SIG_IGN);
    int ends[2];
    if (pipe(ends) != 0) return 1;
    close(ends[0]);
    std::FILE* const pipe = fdopen(ends[1], "w");
    std::FILE* const full = std::fopen("/dev/full", "w");
    if (!pipe || !full) return 2;
    for (std::FILE* stream : {pipe, full}) print_to(stream, "{} robots\n", 3);
    return 0;
  });
  CHECK(code == 0);
}

TEST_CASE("output reaches the file immediately") {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  std::FILE* const stream = fdopen(ends[1], "w");
  REQUIRE(stream);
  print_to(stream, "{} robots\n", 3);
  char text[20] = {};
  CHECK(read(ends[0], text, sizeof text) == 9);
  CHECK(std::string(text) == "3 robots\n");
  std::fclose(stream);
  close(ends[0]);
}

TEST_CASE("an opened file does not become stdin, stdout or stderr if these are closed") {
  const int code = exit_code_of([] {
    for (const int descriptor : {0, 2}) close(descriptor);
    const auto target = [](int descriptor) {
      std::error_code error;
      return std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(descriptor), error).string();
    };
    const std::string output = target(1);
    reopen_standard_streams();
    if (target(0) != "/dev/null" || target(1) != output || target(2) != "/dev/null") return 1;
    return open("/dev/zero", O_RDONLY) > 2 ? 0 : 2;
  });
  CHECK(code == 0);
}

}  // namespace sidestep
