// SPDX-License-Identifier: Apache-2.0
// The examples of the client library, with real processes.
#include <signal.h>

#include "tests/catch.hpp"
#include "tests/faults/launched_run.hpp"

namespace sidestep::client_faults_test {

/// Starts an example alongside the run.
void start(LaunchedRun& run, const std::string& name, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), run.dds_arguments()[1]);
  run.start(name, "sidestep-" + name, arguments);
}

bool has_ended(const LaunchedRun& run, const std::string& name) { return run.exit_reason(name).has_value(); }

int count(const std::string& text, const std::string& part) {
  int found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

/// Ends the run with Ctrl-C, like a user.
void finish(LaunchedRun& run) {
  REQUIRE(kill(run.pid(), SIGINT) == 0);
  CHECK(run.wait_for_end() == "exit code 0");
  require_no_violations(run.report());
}

TEST_CASE("the patrol drives a robot back and forth until another client sends it elsewhere") {
  LaunchedRun run(shipped_scenario("on-demand"));
  REQUIRE(run.wait_until([&] { return run.printed("the coordinator grants"); }));
  start(run, "patrol", {"3", "2", "-1,1", "-2.2,0.6"});
  CHECK(run.wait_until([&] { return has_ended(run, "patrol"); }));
  INFO(run.output());
  CHECK(run.exit_reason("patrol") == "exit code 0");
  CHECK(run.printed("robot 3: round 2 of 2 is done"));

  start(run, "patrol", {"3", "1000", "-1,1", "-2.2,0.6"});
  REQUIRE(run.wait_until([&] { return run.printed("round 1 of 1000 is done"); }));
  std::vector<std::string> other{"go", "3", "-2.5,1.5", "--client", "other"};
  for (const std::string& argument : run.dds_arguments()) other.push_back(argument);
  CHECK(run.command(other) == "exit code 0");
  CHECK(run.wait_until([&] { return has_ended(run, "patrol"); }));
  CHECK(run.exit_reason("patrol") == "exit code 1");
  CHECK(run.printed("another client has sent the robot elsewhere"));
  start(run, "patrol", {"30", "1", "-1,1", "-2.2,0.6"});
  CHECK(run.wait_until([&] { return run.printed("the order was refused"); }));
  finish(run);
}

TEST_CASE(
    "the dispatcher sends the nearest free robots although an agent is killed and another client has sent a "
    "robot away") {
  LaunchedRun run(shipped_scenario("on-demand"));
  REQUIRE(run.wait_until([&] { return run.printed("the coordinator grants"); }));
  std::vector<std::string> away{"go", "0", "-2.5,-2", "--client", "other"};
  for (const std::string& argument : run.dds_arguments()) away.push_back(argument);
  start(run, "dispatcher", {"-1.5,-1.5", "1.5,-1.5", "-1.5,1.5", "1.5,1.5", "0,0.5", "0,-0.5"});
  REQUIRE(run.wait_until([&] { return run.printed("job at -1.5,-1.5: robot 0 is sent"); }));
  CHECK(run.command(away) == "exit code 0");
  REQUIRE(kill(run.pid_of("agent 4"), SIGKILL) == 0);
  CHECK(run.wait_until([&] { return has_ended(run, "dispatcher"); }));
  INFO(run.output());
  CHECK(run.exit_reason("dispatcher") == "exit code 0");
  CHECK(run.printed("job at 1.5,-1.5: robot 4 is sent"));
  CHECK(run.printed("job at -1.5,1.5: robot 3 is sent"));
  CHECK(run.printed("job at 1.5,1.5: robot 7 is sent"));
  CHECK(count(run.output(), "has arrived") == 6);
  start(run, "dispatcher", {"99,0"});
  CHECK(run.wait_until([&] { return run.printed("the place is refused"); }));
  finish(run);
}

}  // namespace sidestep::client_faults_test
