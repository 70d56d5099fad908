// SPDX-License-Identifier: Apache-2.0
#include <regex>
#include <string>
#include <vector>

#include "tests/catch.hpp"
#include "tests/faults/launched_run.hpp"
#include "tests/faults/wrong_clock_host.hpp"
#include "tests/sanitized.hpp"

namespace sidestep::host_clock_test {

using namespace std::chrono_literals;

constexpr const char* kRestartMessage = ": restarting: the host's clock was set";
constexpr const char* kClockSetMessage = ": the host's clock was set";

/// Assigns the processes of scenario crossing to hosts, and says how far the late host's clock is ahead
/// initially.
struct LateStart {
  const char* late;
  const char* right;
  std::vector<std::string> late_processes;  ///< names in the log
  Duration ahead;
};

/// Starts the run, corrects the late host's clock once all its processes have started, and requires that they
/// restart and that all robots arrive.
void check_recovery(const LateStart& start) {
  if (kIsSanitized) return;  // a sanitizer's library must be loaded before the test's
  const WrongClockHost host(start.late, start.right, start.ahead);
  LaunchedRun run(shipped_scenario("crossing"), {"--hosts", host.hosts_file()});
  REQUIRE(run.wait_until([&] { return run.children().size() == 11; }));
  for (const std::string& process : start.late_processes)
    REQUIRE(run.wait_until([&] { return run.logged(process + ": Fast DDS"); }));
  const auto children = run.children();
  host.set_clock(0s);
  for (const std::string& process : start.late_processes)
    CHECK(run.wait_until([&] { return run.logged(process + kRestartMessage); }));
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == "exit code 0");
  const auto report = run.report();
  require_no_violations(report);
  CHECK(report["arrived"] == 8);
  CHECK(report["deaths"].empty());
  CHECK(run.children() == children);
}

TEST_CASE("all processes except the simulator, started with a clock a day behind, recover once it is set") {
  check_recovery({"processes: [vision, coordinator], agents: [0-7]",
                  "processes: [simulator]",
                  {"sidestep-coordinator", "sidestep-vision", "agent-0", "agent-7"},
                  -24h});
}

TEST_CASE("agents that started with a clock a day ahead recover once it is set") {
  check_recovery({"agents: [4-7]",
                  "processes: [simulator, vision, coordinator], agents: [0-3]",
                  {"agent-4", "agent-5", "agent-6", "agent-7"},
                  24h});
}

TEST_CASE("a coordinator that started with a clock 0.3 s behind recovers once it is set") {
  check_recovery({"processes: [coordinator]",
                  "processes: [simulator, vision], agents: [0-7]",
                  {"sidestep-coordinator"},
                  -300ms});
}

TEST_CASE("vision that started with a clock 2 s ahead recovers once it is set") {
  check_recovery(
      {"processes: [vision]", "processes: [simulator, coordinator], agents: [0-7]", {"sidestep-vision"}, 2s});
}

TEST_CASE(
    "a simulator that started with a clock two hours behind recovers once it is set, if its robots obey no "
    "agent yet") {
  check_recovery({"processes: [simulator]",
                  "processes: [vision, coordinator], agents: [0-7]",
                  {"sidestep-simulator"},
                  -2h});
}

TEST_CASE("setting a host's clock during a healthy run does not disturb the run", "[slow]") {
  if (kIsSanitized) return;  // a sanitizer's library must be loaded before the test's
  const Duration ahead = GENERATE(Duration(1h), Duration(-24h), Duration(-300ms));
  CAPTURE(to_seconds(ahead));
  const WrongClockHost host("processes: [coordinator], agents: [4-7]",
                            "processes: [simulator, vision], agents: [0-3]", 0s);
  LaunchedRun run(shuttles(3, ""), {"--hosts", host.hosts_file()});
  INFO(run.output());
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 0.8; }));
  host.set_clock(ahead);
  for (const char* process : {"sidestep-coordinator", "agent-4", "agent-5", "agent-6", "agent-7"})
    CHECK(run.wait_until([&] { return run.logged(std::string(process) + kClockSetMessage); }));
  CHECK(run.wait_for_end() == "exit code 0");
  CHECK_FALSE(run.logged(kRestartMessage));
  const auto report = run.report();
  require_no_violations(report);
  CHECK(report["arrived"] == 8);
  CHECK(report["epochs"].size() == 1);
}

TEST_CASE("`sidestep clock` lists processes whose clocks are wrong, and hosts whose clock has been set",
          "[slow]") {
  if (kIsSanitized) return;  // a sanitizer's library must be loaded before the test's
  const WrongClockHost host("agents: [4-7]", "processes: [simulator, vision, coordinator], agents: [0-3]",
                            2s);
  LaunchedRun run(shuttles(20, ""), {"--hosts", host.hosts_file(), "--seconds", "20"});
  REQUIRE(run.wait_until([&] { return run.speed_mps(5) > 0.5; }));
  std::vector<std::string> clock{"clock", "--once"};
  for (const std::string& argument : run.dds_arguments()) clock.push_back(argument);
  CHECK(run.command(clock) == "exit code 1");
  const std::regex ahead("agent 5 +beyond +\\+(1999|2000)\\.\\d* ± .* ms "),
      right("agent 3 +(within|unclear) +[+-]0\\.\\d* ± .* ms ");
  CHECK(std::regex_search(run.output(), ahead));
  CHECK(std::regex_search(run.output(), right));
  CHECK(run.output().find("since it started") == std::string::npos);
  host.set_clock(0s);
  CHECK(run.command(clock) == "exit code 1");
  CHECK(run.output().find("its host's clock has been set by -2.000 s since it started") != std::string::npos);
  CHECK(run.speed_mps(5) + run.speed_mps(4) + run.speed_mps(6) + run.speed_mps(7) > 0);
  INFO(run.output());
  CHECK(run.wait_for_end() == "exit code 1");  // the time is up before the last goals
  require_no_violations(run.report());
}

}  // namespace sidestep::host_clock_test
