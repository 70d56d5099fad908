// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/launcher_input.hpp"

#include <array>
#include <thread>
#include <unistd.h>

#include "tests/catch.hpp"

namespace sidestep::launcher_input_test {

std::array<int, 2> new_pipe() {
  std::array<int, 2> ends{};
  REQUIRE(pipe(ends.data()) == 0);
  return ends;
}

/// A pipe to a LauncherInput.
struct Pipe {
  std::array<int, 2> ends = new_pipe();
  LauncherInput input{ends[0]};

  Pipe() = default;
  ~Pipe() {
    close_writer();
    close(ends[0]);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void send(const std::string& text) {
    REQUIRE(write(ends[1], text.data(), text.size()) == static_cast<ssize_t>(text.size()));
  }
  void close_writer() {
    if (ends[1] >= 0) close(ends[1]);
    ends[1] = -1;
  }
};

TEST_CASE("the first line from the launcher is the token, and a later one says that the run is over") {
  Pipe pipe;
  pipe.send("0123");
  std::thread launcher([&] { pipe.send("abcd\n"); });
  CHECK(pipe.input.read_token() == "0123abcd");
  launcher.join();
  pipe.input.poll();
  CHECK_FALSE(pipe.input.is_run_over());
  pipe.send("something else\nthe run is");
  pipe.input.poll();
  CHECK_FALSE(pipe.input.is_run_over());
  pipe.send(" over\n");
  pipe.input.poll();
  CHECK(pipe.input.is_run_over());
  CHECK_FALSE(pipe.input.has_ended());
  pipe.close_writer();
  pipe.input.poll();
  CHECK(pipe.input.has_ended());
  pipe.input.poll();
  CHECK(pipe.input.has_ended());
}

TEST_CASE("the token may be empty, and what arrives with it is not lost") {
  Pipe pipe;
  pipe.send(std::string("\n") + LauncherInput::kRunIsOver + "\n");
  CHECK(pipe.input.read_token().empty());
  pipe.close_writer();
  pipe.input.poll();
  CHECK(pipe.input.is_run_over());
}

TEST_CASE("if the launcher's input ends before the token, there is none") {
  Pipe pipe;
  pipe.send("half");
  pipe.close_writer();
  CHECK(pipe.input.read_token().empty());
  CHECK(pipe.input.has_ended());
}

}  // namespace sidestep::launcher_input_test
