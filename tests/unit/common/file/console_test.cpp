// SPDX-License-Identifier: Apache-2.0
#include "common/file/console.hpp"

#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <stdexcept>
#include <stdio_ext.h>
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

namespace {

/// Redirects stdout to a descriptor, calls the work, and returns the message of the exception that it throws.
template <typename Work>
std::string problem_with_output(int descriptor, Work work) {
  std::signal(SIGPIPE, SIG_IGN);
  std::fflush(stdout);
  const int saved = dup(STDOUT_FILENO);
  dup2(descriptor, STDOUT_FILENO);
  std::string problem;
  try {
    work();
  } catch (const std::runtime_error& error) {
    problem = error.what();
  }
  __fpurge(stdout);
  std::clearerr(stdout);
  dup2(saved, STDOUT_FILENO);
  close(saved);
  return problem;
}

}  // namespace

TEST_CASE("output that is all of a command's work ends it with the cause if it cannot be written") {
  const int full = open("/dev/full", O_WRONLY);
  REQUIRE(full >= 0);
  const auto print = [] { print_output("{} robots\n", 3); };
  const auto print_late = [] {
    fmt::print("{} robots\n", 3);
    finish_output();
  };
  CHECK(problem_with_output(full, print) == "cannot write to standard output: No space left on device");
  CHECK(problem_with_output(full, print_late) == "cannot write to standard output: No space left on device");
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  CHECK(problem_with_output(ends[1], print).empty());
  CHECK(problem_with_output(ends[1], print_late).empty());
  close(ends[0]);
  CHECK(problem_with_output(ends[1], print) ==
        "cannot write to standard output: the process that read it has ended");
  close(ends[1]);
  // What could not be written does not disturb later output.
  CHECK(problem_with_output(full, [] {
          print_to(stdout, "{} robots\n", 3);
          finish_output();
        }).empty());
  close(full);
}

TEST_CASE("output counts as abandoned once nobody can read it") {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  bool before = true, after = false;
  (void)problem_with_output(ends[1], [&] { before = is_output_abandoned(); });
  close(ends[0]);
  (void)problem_with_output(ends[1], [&] { after = is_output_abandoned(); });
  close(ends[1]);
  CHECK_FALSE(before);
  CHECK(after);
  for (const char* device : {"/dev/null", "/dev/full"}) {
    const int descriptor = open(device, O_WRONLY);
    bool is_abandoned = true;
    (void)problem_with_output(descriptor, [&] { is_abandoned = is_output_abandoned(); });
    close(descriptor);
    CHECK_FALSE(is_abandoned);
  }
}

TEST_CASE("writing to a stdout that was closed fails, and to a stderr that was closed does not") {
  const int code = exit_code_of([] {
    close(STDOUT_FILENO);
    close(STDERR_FILENO);
    reopen_standard_streams();
    if (write_text(stdout, "x") != EBADF) return 1;
    return write_text(stderr, "x") == 0 ? 0 : 2;
  });
  CHECK(code == 0);
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
