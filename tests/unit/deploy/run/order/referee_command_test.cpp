// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/order/referee_command.hpp"

#include "tests/catch.hpp"

namespace sidestep::referee_command_test {

/// The error for these arguments; empty if they are accepted.
std::string usage_error(const std::vector<std::string>& arguments) {
  CommandLine command_line("test", "sidestep");
  std::function<int()> action;
  add_referee_command(command_line.root(), action);
  try {
    command_line.parse(arguments);
  } catch (const UsageError& error) {
    return error.what();
  }
  return action ? "" : "no action";
}

TEST_CASE("an invalid referee command is rejected before anything is sent") {
  CHECK(usage_error({"referee", "HALT"}).empty());
  CHECK(usage_error({"referee", "BALL_PLACEMENT_BLUE", "--place", "-1,0.5"}).empty());
  CHECK_THAT(usage_error({"referee"}), ContainsSubstring("COMMAND"));
  CHECK_THAT(
      usage_error({"referee", "PAUSE"}),
      ContainsSubstring("\"PAUSE\" is not a command of the referee") && ContainsSubstring("HALT, STOP, "));
  CHECK_THAT(usage_error({"referee", "STOP", "--place", "1"}),
             ContainsSubstring("\"1\" is not a place for the ball, expected X,Y in metres"));
  CHECK_THAT(usage_error({"referee", "STOP", "--place", "10001,0"}),
             ContainsSubstring("from -10000 to 10000 m"));
}

}  // namespace sidestep::referee_command_test
