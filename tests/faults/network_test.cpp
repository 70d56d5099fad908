// SPDX-License-Identifier: Apache-2.0
#include <map>

#include "tests/catch.hpp"
#include "tests/faults/launched_run.hpp"

using namespace sidestep;

namespace {

/// The arguments of `sidestep fault` for this run.
std::vector<std::string> fault(const LaunchedRun& run, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "fault");
  const auto dds_arguments = run.dds_arguments();
  arguments.insert(arguments.end(), dds_arguments.begin(), dds_arguments.end());
  return arguments;
}

}  // namespace

TEST_CASE("all robots arrive although messages are lost in bursts, delayed, duplicated and reordered") {
  LaunchedRun run(shuttles(3, ""), {"--faults"});
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 0.8; }));
  REQUIRE(run.command(fault(run, {"network", "--target", "all", "--loss", "0.1", "--burst", "3", "--delay-ms",
                                  "0,5,50", "--duplicate", "0.2"})) == "exit code 0");
  for (const char* process :
       {"agent-0", "agent-7", "sidestep-coordinator", "sidestep-vision", "sidestep-simulator"}) {
    INFO(process);
    const std::string text = std::string(process) + ": network fault: 10 % lost in bursts of 3";
    CHECK(run.wait_until([&] { return run.logged(text); }));
  }
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == "exit code 0");
  const auto report = run.report();
  require_no_violations(report);
  CHECK(report["arrived"] == 8);
  WARN("10 % loss in bursts, 0 to 50 ms delay, 20 % duplicates: " << report["missed_cycles"] << " of "
                                                                  << report["cycles"] << " cycles missed");
}

TEST_CASE("all robots stop while the coordinator is cut off, and continue when the fault is cleared") {
  LaunchedRun run(shuttles(4, ""), {"--faults"});
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 0.8; }));
  REQUIRE(run.command(fault(run, {"network", "--target", "coordinator", "--cut"})) == "exit code 0");
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() < 0.03; }));
  REQUIRE(run.command(fault(run, {"network", "--target", "coordinator", "--clear"})) == "exit code 0");
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == "exit code 0");
  require_no_violations(run.report());
  CHECK(run.report()["arrived"] == 8);
}

TEST_CASE("a network fault or push that cannot be applied is refused with a reason") {
  LaunchedRun run(shuttles(20, ""));
  // A monitor and a recorder read the faults too.
  run.bus().observe<msg::NetworkFault>(topics::kNetworkFault, 0, [](const msg::NetworkFault&) {});
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 0.5; }));
  CHECK(run.command(fault(run, {"network", "--target", "all", "--cut"})) == "exit code 1");
  CHECK(run.printed("no process accepts these faults in domain "));
  CHECK(run.command(fault(run, {"network", "--target", "agent x", "--cut"})) == "exit code 2");
  CHECK(run.printed("got 'agent x'"));
  CHECK(run.command(fault(run, {"network", "--target", "all"})) == "exit code 2");
  CHECK(run.command(fault(run, {"network", "--target", "all", "--cut", "--clear"})) == "exit code 2");
  CHECK(run.command(fault(run, {"network", "--target", "all", "--delay-ms", "5,2,1"})) == "exit code 2");
  CHECK(run.command(fault(run, {"push", "77", "--velocity", "0.1,0"})) == "exit code 1");
  CHECK(run.printed("no robot 77 in this run"));
  CHECK(run.command(fault(run, {"push", "3"})) == "exit code 2");
  CHECK(run.command(fault(run, {"push", "3", "--velocity", "10.1,0"})) == "exit code 2");
  CHECK(run.command(fault(run, {"place", "3", "--at", "0.5,2.0"})) == "exit code 1");
  CHECK(run.printed("the simulator refuses the fault: robot 3 is on the floor"));
  CHECK(run.command(fault(run, {"switch-on", "3"})) == "exit code 1");
  CHECK(run.printed("the simulator refuses the fault: robot 3 is switched on"));
  CHECK(run.command(fault(run, {"carry", "3", "--to", "900,0"})) == "exit code 1");
  CHECK(run.printed("a value is out of range, or the place is outside the field"));
  CHECK(run.max_speed_mps() > 0);
}

TEST_CASE("a pushed robot reports that it is off its reference, continues and arrives") {
  LaunchedRun run(shuttles(3, ""));
  REQUIRE(run.wait_until([&] { return run.speed_mps(2) > 0.8; }));
  bool is_off_reference = false;
  run.bus().subscribe(topics::kFeedback, 2, std::function([&](const msg::Feedback& feedback) {
                        is_off_reference = is_off_reference || feedback.is_off_reference();
                      }));
  REQUIRE(run.command(fault(run, {"push", "2", "--velocity", "0,0.4"})) == "exit code 0");
  CHECK(run.wait_until([&] { return is_off_reference; }));
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == "exit code 0");
  require_no_violations(run.report());
  CHECK(run.report()["arrived"] == 8);
}

TEST_CASE(
    "robots arrive although they slip, are blocked, rebooted or lifted and placed, or get a wrong clock",
    "[slow]") {
  LaunchedRun run(shuttles(5, ""));
  std::map<RobotId, msg::Feedback> robot_reports;
  std::map<RobotId, bool> was_off;
  std::map<RobotId, msg::AgentState> states;
  for (RobotId robot = 0; robot < 8; ++robot) {
    run.bus().subscribe(topics::kFeedback, robot, std::function([&](const msg::Feedback& feedback) {
                          robot_reports[feedback.robot()] = feedback;
                          was_off[feedback.robot()] |= feedback.is_off_reference();
                        }));
  }
  run.bus().subscribe(topics::kStatus, std::function([&](const msg::AgentStatus& status) {
                        states[status.robot()] = status.agent_state();
                      }));
  REQUIRE(run.wait_until([&] { return robot_reports.size() == 8; }));
  // Robots are disturbed only where no other robot crosses their lane, because a disturbance may cause a
  // contact.
  const auto is_leaving = [&](RobotId robot) {
    return std::ranges::any_of(run.truth().robots(), [&](const msg::TrueRobotState& r) {
      return r.robot() == robot && std::abs(r.x_m()) > 1.1 && r.x_m() * r.vx_mps() > 0.5;
    });
  };
  const auto apply = [&](const std::vector<std::string>& arguments) {
    CAPTURE(arguments);
    REQUIRE(run.command(fault(run, arguments)) == "exit code 0");
  };
  const auto apply_once_clear = [&](RobotId robot, std::vector<std::string> arguments) {
    REQUIRE(run.wait_until([&] { return is_leaving(robot); }));
    arguments.insert(arguments.begin() + 1, std::to_string(robot));
    apply(std::move(arguments));
  };
  apply_once_clear(0, {"slip", "--grip", "0.1", "--seconds", "2"});
  apply_once_clear(1, {"block", "--heading", "0.3", "--seconds", "1"});
  apply_once_clear(2, {"reboot"});
  CHECK(run.wait_until([&] { return was_off[0] && was_off[1] && was_off[2]; }));

  apply_once_clear(3, {"clock", "--offset-ms", "400"});
  CHECK(run.wait_until(
      [&] { return states[3] == msg::AgentState::AGENT_CLOCK_OUT_OF_BOUND && run.speed_mps(3) < 0.03; }));
  apply({"clock", "3", "--offset-ms", "0"});
  CHECK(run.wait_until([&] { return run.speed_mps(3) > 0.5; }));

  apply({"lift", "5"});
  CHECK(run.wait_until([&] { return robot_reports[5].is_lifted(); }));
  apply({"place", "5", "--at", "4,2.6"});
  CHECK(run.wait_until(
      [&] { return !robot_reports[5].is_lifted() && robot_reports[5].executing().version_number() != 0; }));
  CHECK(run.wait_until([&] { return run.speed_mps(5) > 0.5; }));

  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == "exit code 0");
  const auto report = run.report();
  REQUIRE(report.is_object());
  CHECK(report["contacts"] == report["audit"]["excused_contacts"]);
  CHECK(report["audit"]["violations"] == 0);
  CHECK(report["audit"]["received"] > 0);
  CHECK(report["arrived"] == 8);
}
