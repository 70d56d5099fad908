// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <map>

#include "tests/faults/launched_run.hpp"

using namespace sidestep;

namespace {

std::vector<std::string> fault(const LaunchedRun& run, std::vector<std::string> words) {
  words.insert(words.begin(), "fault");
  const auto where = run.dds_arguments();
  words.insert(words.end(), where.begin(), where.end());
  return words;
}

}  // namespace

TEST_CASE("all arrive though messages are lost in bursts, late, doubled and overtaken") {
  LaunchedRun run(shuttles(3, ""), {"--faults"});
  REQUIRE(run.until([&] { return run.fastest_mps() > 0.8; }));
  REQUIRE(run.command(fault(run, {"network", "--target", "all", "--loss", "0.1", "--burst", "3", "--delay-ms",
                                  "0,5,50", "--duplicate", "0.2"})) == "exit code 0");
  for (const char* process :
       {"agent-0", "agent-7", "sidestep-coordinator", "sidestep-vision", "sidestep-simulator"}) {
    INFO(process);
    const std::string words = std::string(process) + ": network fault: 10 % lost in bursts of 3";
    CHECK(run.until([&] { return run.logged(words); }));
  }
  CHECK(run.wait_for_end() == "exit code 0");
  INFO(run.output());
  const auto report = run.report();
  require_untouched(report);
  CHECK(report["arrived"] == 8);
  WARN("10 % lost in bursts, 0 to 50 ms late, 20 % doubled: " << report["missed_cycles"] << " of "
                                                              << report["cycles"] << " cycles missed");
}

TEST_CASE("a coordinator that hears nothing stops everybody, and one order sets it free again") {
  LaunchedRun run(shuttles(4, ""), {"--faults"});
  REQUIRE(run.until([&] { return run.fastest_mps() > 0.8; }));
  REQUIRE(run.command(fault(run, {"network", "--target", "coordinator", "--cut"})) == "exit code 0");
  REQUIRE(run.until([&] { return run.fastest_mps() < 0.03; }));
  REQUIRE(run.command(fault(run, {"network", "--target", "coordinator", "--clear"})) == "exit code 0");
  CHECK(run.wait_for_end() == "exit code 0");
  INFO(run.output());
  require_untouched(run.report());
  CHECK(run.report()["arrived"] == 8);
}

TEST_CASE("fault orders that cannot be carried out are refused with the reason") {
  LaunchedRun run(shuttles(20, ""));
  REQUIRE(run.until([&] { return run.fastest_mps() > 0.5; }));
  CHECK(run.command(fault(run, {"network", "--target", "all", "--cut"})) == "exit code 1");
  CHECK(run.printed("nobody takes such orders"));
  CHECK(run.command(fault(run, {"network", "--target", "agent x", "--cut"})) == "exit code 2");
  CHECK(run.printed("got 'agent x'"));
  CHECK(run.command(fault(run, {"network", "--target", "all"})) == "exit code 2");
  CHECK(run.command(fault(run, {"network", "--target", "all", "--cut", "--clear"})) == "exit code 2");
  CHECK(run.command(fault(run, {"network", "--target", "all", "--delay-ms", "5,2,1"})) == "exit code 2");
  CHECK(run.command(fault(run, {"push", "77", "--velocity", "0.1,0"})) == "exit code 1");
  CHECK(run.printed("there is no robot 77 on this floor"));
  CHECK(run.command(fault(run, {"push", "3"})) == "exit code 2");
  CHECK(run.fastest_mps() > 0);
}

TEST_CASE("a robot that an operator pushes says that it is off its reference, drives on and arrives") {
  LaunchedRun run(shuttles(3, ""));
  REQUIRE(run.until([&] { return run.speed_mps(2) > 0.8; }));
  bool is_off_reference = false;
  run.bus().subscribe(topics::kFeedback, 2, std::function([&](const msg::Feedback& feedback) {
                        is_off_reference = is_off_reference || feedback.is_off_reference();
                      }));
  REQUIRE(run.command(fault(run, {"push", "2", "--velocity", "0,0.4"})) == "exit code 0");
  CHECK(run.until([&] { return is_off_reference; }));
  CHECK(run.wait_for_end() == "exit code 0");
  INFO(run.output());
  require_untouched(run.report());
  CHECK(run.report()["arrived"] == 8);
}

TEST_CASE(
    "robots that slip, block, start again, are lifted and set drive on and arrive, each as it is told") {
  LaunchedRun run(shuttles(5, ""));
  std::map<RobotId, msg::Feedback> facts;
  std::map<RobotId, bool> was_off;
  std::map<RobotId, msg::AgentState> phases;
  for (RobotId robot = 0; robot < 8; ++robot) {
    run.bus().subscribe(topics::kFeedback, robot, std::function([&](const msg::Feedback& feedback) {
                          facts[feedback.robot()] = feedback;
                          was_off[feedback.robot()] |= feedback.is_off_reference();
                        }));
  }
  run.bus().subscribe(topics::kStatus, std::function([&](const msg::AgentStatus& status) {
                        phases[status.robot()] = status.agent_state();
                      }));
  REQUIRE(run.until([&] { return facts.size() == 8; }));
  // On its way out of where others cross its lane: hands are beyond the bounds, and could bring it into
  // contact.
  const auto is_leaving = [&](RobotId robot) {
    return std::ranges::any_of(run.truth().robots(), [&](const msg::TruthRobot& r) {
      return r.robot() == robot && std::abs(r.x_m()) > 1.1 && r.x_m() * r.vx_mps() > 0.5;
    });
  };
  const auto order = [&](std::vector<std::string> words) {
    CAPTURE(words);
    REQUIRE(run.command(fault(run, std::move(words))) == "exit code 0");
  };
  const auto order_leaving = [&](RobotId robot, std::vector<std::string> words) {
    REQUIRE(run.until([&] { return is_leaving(robot); }));
    words.insert(words.begin() + 1, std::to_string(robot));
    order(std::move(words));
  };
  order_leaving(0, {"slip", "--grip", "0.1", "--seconds", "2"});
  order_leaving(1, {"block", "--heading", "0.3", "--seconds", "1"});
  order_leaving(2, {"reboot"});
  CHECK(run.until([&] { return was_off[0] && was_off[1] && was_off[2]; }));

  order_leaving(3, {"clock", "--offset-ms", "400"});
  CHECK(run.until([&] { return phases[3] == msg::AGENT_OFF_CLOCK && run.speed_mps(3) < 0.03; }));
  order({"clock", "3", "--offset-ms", "0"});

  order({"lift", "5"});
  CHECK(run.until([&] { return facts[5].is_lifted(); }));
  order({"place", "5", "--at", "4,2.6"});
  CHECK(run.until([&] { return !facts[5].is_lifted() && facts[5].executing().version_number() != 0; }));
  CHECK(run.until([&] { return run.speed_mps(3) > 0.5 && run.speed_mps(5) > 0.5; }));

  CHECK(run.wait_for_end() == "exit code 0");
  INFO(run.output());
  const auto report = run.report();
  REQUIRE(report.is_object());
  CHECK(report["contacts"] == report["audit"]["contacts_by_hand"]);
  CHECK(report["audit"]["violations"] == 0);
  CHECK(report["audit"]["heard"] > 0);
  CHECK(report["arrived"] == 8);
}
