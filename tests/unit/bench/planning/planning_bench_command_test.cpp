// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/planning/planning_bench_command.hpp"

#include "common/process/command_line.hpp"
#include "common/process/process.hpp"
#include "tests/catch.hpp"

namespace sidestep::planning_bench_command_test {

/// The exit code of `planning ARGUMENTS` in one world with a few queries.
int bench(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"test", "planning"});
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  CommandLine command_line("test", "test");
  const CliCommand app = command_line.root();
  std::function<int()> action;
  add_planning_bench_command(app, action);
  const auto exit_code = command_line.parse(static_cast<int>(argv.size()), argv.data());
  return exit_code ? *exit_code : action();
}

const std::vector<std::string> kQuick{"--world", "u", "--queries", "40",
                                      "--seeds", "2", "--planner", "rrt-connect"};

std::vector<std::string> quick_with(std::initializer_list<std::string> more) {
  std::vector<std::string> arguments = kQuick;
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST_CASE("the planning benchmark exits with 0 without a failure") { CHECK(bench(kQuick) == 0); }

TEST_CASE("the planning benchmark exits with 1 when a planner returns an invalid path") {
  CHECK(bench(quick_with({"--plant", "invalid-path"})) == kExitFailure);
}

TEST_CASE(
    "the planning benchmark exits with 1 when our planner solves significantly fewer queries than OMPL's") {
  CHECK(bench(quick_with({"--plant", "weak-namesake"})) == kExitFailure);
}

TEST_CASE("the planning benchmark rejects invalid arguments") {
  CHECK(bench({"--world", "ocean"}) == kExitUsage);
  CHECK(bench({"--planner", "dijkstra"}) == kExitUsage);
  CHECK(bench({"--plant", "roses"}) == kExitUsage);
  CHECK(bench({"--queries", "0"}) == kExitUsage);
  CHECK(bench({"--ms", "-1"}) == kExitUsage);
}

}  // namespace sidestep::planning_bench_command_test
