// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <set>

#include "common/json/json_text.hpp"
#include "common/messaging/dds/presence.hpp"
#include "tests/catch.hpp"
#include "tests/faults/launched_run.hpp"

using namespace sidestep;

namespace {

/// Stops a process with SIGSTOP for this duration.
void pause(LaunchedRun& run, pid_t pid, Duration duration) {
  REQUIRE(pid != 0);
  const Time until = run.bus().now() + duration;
  REQUIRE(kill(pid, SIGSTOP) == 0);
  CHECK(run.wait_until([&] { return run.bus().now() >= until; }));
  REQUIRE(kill(pid, SIGCONT) == 0);
}

}  // namespace

TEST_CASE("all robots arrive without contact although each kind of process pauses for two seconds",
          "[slow]") {
  LaunchedRun run(shuttles(7, "coordinators: 2\n"));
  for (const char* process : {"agent 2", "vision", "coordinator", "coordinator 1", "simulator"}) {
    INFO(process << "\n" << run.output());
    REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 0.8; }));
    pause(run, run.pid_of(process), std::chrono::seconds(2));
  }
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == "exit code 0");
  require_no_violations(run.report());
  CHECK(run.report()["arrived"] == 8);
}

TEST_CASE(
    "processes that pause until others forget them are rediscovered, including the launcher during startup",
    "[half-core][slow]") {
  LaunchedRun run(shuttles(5, ""));
  const Duration until_forgotten = kSilenceLimit + std::chrono::seconds(2);
  REQUIRE(run.wait_until([&] { return run.printed("started agent 1"); }));
  pause(run, run.pid(), until_forgotten);
  for (const char* process : {"agent 2", "vision", "coordinator", "simulator"}) {
    INFO(process << "\n" << run.output());
    REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 0.8; }));
    pause(run, run.pid_of(process), until_forgotten);
  }
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  check_passed_or_missed_messages(run, ended);
  require_no_violations(run.report());
  CHECK(run.report()["arrived"] == 8);
}

TEST_CASE("a camera process that pauses until others forget it is rediscovered, and its images arrive again",
          "[both-cores]") {
  LaunchedRun run(crossing_images(), {"--seconds", "120"});
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 0.8; }));
  pause(run, run.pid_of("simulator"), kSilenceLimit + std::chrono::seconds(2));
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  check_passed_or_missed_messages(run, ended);
  require_no_violations(run.report());
  CHECK(run.report()["arrived"] == 8);
  CHECK(json_text(run.report()["counters"]).find("forgotten_peer") != std::string::npos);
}

TEST_CASE("all robots arrive although both coordinators in turn and an agent are killed with kill -9") {
  LaunchedRun run(shuttles(5, "coordinators: 2\nrestart: [agents, coordinator]\n"));
  for (const char* process : {"coordinator 1", "agent 6", "coordinator"}) {
    INFO(process << "\n" << run.output());
    REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 0.8; }));
    const pid_t before = run.pid_of(process);
    REQUIRE(before > 0);
    REQUIRE(kill(before, SIGKILL) == 0);
    REQUIRE(run.wait_until([&] { return run.pid_of(process) != before; }));
  }
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == "exit code 0");
  require_no_violations(run.report());
  CHECK(run.report()["arrived"] == 8);
  CHECK(run.report()["deaths"].size() == 3);
}

TEST_CASE("after kill -9 of the simulator, the run ends and reports that it died") {
  LaunchedRun run(shuttles(8, ""));
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 0.8; }));
  REQUIRE(kill(run.pid_of("simulator"), SIGKILL) == 0);
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == "exit code 1");
  CHECK(run.printed("failed: simulator died"));
  require_no_violations(run.report());
}

TEST_CASE("if a robot has two agents, the agent started later drives the robot without contact") {
  LaunchedRun run(shuttles(5, ""));
  REQUIRE(run.wait_until([&] { return run.speed_mps(3) > 0.8; }));
  std::vector<std::string> arguments{"--scenario", run.scenario_file(), "--robot", "3"};
  for (const std::string& word : run.dds_arguments()) arguments.push_back(word);
  const pid_t twin = run.start("twin", "sidestep-agent", arguments);
  std::set<std::uint64_t> obeyed;
  run.bus().subscribe(topics::kFeedback, 3, std::function([&](const msg::Feedback& feedback) {
                        obeyed.insert(feedback.obeyed_incarnation());
                      }));
  CHECK(run.wait_until([&] { return obeyed.size() == 2; }));
  CHECK(is_running(run.pid_of("agent 3")));
  CHECK(is_running(twin));
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == "exit code 0");
  CHECK_FALSE(run.exit_reason("twin"));
  require_no_violations(run.report());
  CHECK(run.report()["arrived"] == 8);
}
