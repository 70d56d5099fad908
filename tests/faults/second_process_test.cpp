// SPDX-License-Identifier: Apache-2.0
// Second processes of kinds that may run only once in a domain, over DDS.
#include <csignal>

#include "common/process/host_name.hpp"
#include "tests/catch.hpp"
#include "tests/faults/launched_run.hpp"

namespace sidestep::second_process_faults_test {

using std::chrono::seconds;

std::vector<std::string> arguments_for(const LaunchedRun& run) {
  std::vector<std::string> result{"--scenario", run.scenario_file()};
  for (const std::string& argument : run.dds_arguments()) result.push_back(argument);
  return result;
}

/// Starts a program alongside the run, waits until it has ended by itself, and until robots drive again.
void check_ends(LaunchedRun& run, const std::string& program, const std::string& kind) {
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 0.5; }));
  run.start("second", program, arguments_for(run));
  REQUIRE(run.wait_until([&] { return run.exit_reason("second").has_value(); }));
  INFO(run.output());
  CHECK(run.exit_reason("second") == "exit code 1");
  CHECK(run.printed("another " + kind + " is running in this domain"));
  // Messages of kinds that both processes have sent are ignored until the second process has been silent for
  // a second.
  const Time ended_at = run.bus().now();
  REQUIRE(run.wait_until([&] { return run.bus().now() > ended_at + seconds(2); }));
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 0.5; }));
  REQUIRE(kill(run.pid(), SIGINT) == 0);
  CHECK(run.wait_for_end() != "");
  require_no_violations(run.report());
  CHECK(run.report()["crashes_while_moving"] == 0);
}

TEST_CASE("a second simulator in a run's domain exits, and the robots continue without contact") {
  LaunchedRun run(shuttles(40, ""));
  check_ends(run, "sidestep-simulator", "simulator");
  CHECK(run.logged("two processes send 'detections' as simulator"));
}

TEST_CASE("a second vision process in a run's domain exits, and the robots continue without contact") {
  LaunchedRun run(shuttles(40, ""));
  check_ends(run, "sidestep-vision", "vision");
}

TEST_CASE(
    "a second run in the same domain starts no process, and exits with a message that names the first run") {
  LaunchedRun run(shuttles(4, ""));
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 0.5; }));
  std::vector<std::string> arguments{"run", run.scenario_file()};
  for (const std::string& argument : run.dds_arguments()) arguments.push_back(argument);
  run.start("second", "sidestep", arguments);
  REQUIRE(run.wait_until([&] { return run.exit_reason("second").has_value(); }));
  CHECK(run.exit_reason("second") == "exit code 2");
  CHECK(run.printed("another run of shuttles on host " + host_name() + " is using it"));
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == "exit code 0");
  require_no_violations(run.report());
  CHECK(run.report()["arrived"] == 8);
}

}  // namespace sidestep::second_process_faults_test
