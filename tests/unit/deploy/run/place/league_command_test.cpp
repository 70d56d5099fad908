// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/place/league_command.hpp"

#include "tests/catch.hpp"

namespace sidestep::league_command_test {
namespace {

/// The error for these arguments; empty if they are accepted.
std::string usage_error(const std::vector<std::string>& arguments) {
  CommandLine command_line("test", "sidestep");
  std::function<int()> action;
  add_league_command(command_line.root(), action);
  try {
    command_line.parse(arguments);
  } catch (const UsageError& error) {
    return error.what();
  }
  return action ? "" : "no action";
}

}  // namespace

TEST_CASE("league place needs a scenario and accepts addresses of the simulator") {
  CHECK(usage_error({"league", "place", "a.yaml"}).empty());
  CHECK(usage_error({"league", "place", "a.yaml", "--control", "127.0.0.1:10300", "--ssl-vision",
                     "224.5.23.2:10020", "--league-interface", "all", "--league-sender", "127.0.0.1"})
            .empty());
  CHECK_THAT(usage_error({"league", "place"}), ContainsSubstring("SCENARIO"));
  CHECK_FALSE(usage_error({"league"}).empty());
}

}  // namespace sidestep::league_command_test
