// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/trial.hpp"

#include "common/config/scenario_loader.hpp"
#include "tests/catch.hpp"

namespace sidestep::trial_test {

using namespace std::chrono_literals;

/// A passing trial with three robots, and the data from which it is judged.
struct Judged {
  Trial trial{
      1,
      parse_scenario("field: {length_m: 6, width_m: 5}\ncircle: {count: 3, spacing_m: 0.6}\n", "three.yaml"),
      {},
      60s};
  std::vector<RobotProgress> progress;
  bool has_arrived = false;
  Report report;
  TrialResult result;

  Judged() {
    for (const RobotSpec& robot : trial.scenario.robots) {
      RobotProgress& row = progress.emplace_back();
      row.robot = robot.id;
      row.agent_state = msg::AgentState::AGENT_DRIVING;
      row.grants = 100;
    }
    report.grants = 300;
    report.audit.emplace();
    report.audit->received = 1000;
    report.audit->run_s = 60;
    report.audit->coverage = {1, 1, 1, 1, 1};
    report.audit->reference = AuditReference::kGroundTruth;
    result.robots = 3;
  }
  void end(RobotId robot, RobotEnd state, msg::AgentState agent) {
    trial.plan.ends[robot] = state;
    progress[robot].agent_state = agent;
  }
  std::vector<std::string> failures() {
    result.failures.clear();
    add_failures(trial, progress, has_arrived, report, result);
    return result.failures;
  }
  void check_fails(const std::string& words) {
    const auto found = failures();
    CAPTURE(found);
    REQUIRE(found.size() == 1);
    CHECK_THAT(found[0], ContainsSubstring(words));
  }
};

TEST_CASE("a trial without a failure passes") {
  Judged judged;
  CHECK(judged.failures().empty());
  judged.end(0, RobotEnd::kLifted, msg::AgentState::AGENT_ABSENT);
  judged.end(1, RobotEnd::kClockOutOfBound, msg::AgentState::AGENT_CLOCK_OUT_OF_BOUND);
  judged.progress[1].grants = 0;
  judged.progress[2].agent_state = msg::AgentState::AGENT_ARRIVED;
  CHECK(judged.failures().empty());
}

TEST_CASE("the last twelve seconds of a trial that is long enough have no faults") {
  const std::uint64_t seed = GENERATE(range(1u, 21u));
  const Duration duration = GENERATE(min_trial_duration(true), 30s, 60s);
  CAPTURE(seed, duration);
  const Trial trial = sample_trial(seed, duration, std::nullopt);
  CHECK(trial.plan.healed_at == duration - 12s);
  for (const TimedFault& fault : trial.plan.faults) CHECK(fault.at <= duration - 12s);
}

TEST_CASE("a trial fails for each kind of failure and states the reason") {
  Judged judged;
  SECTION("there was a contact") {
    judged.result.contacts = 1;
    judged.check_fails("1 contacts");
  }
  SECTION("there was an audit violation") {
    judged.report.audit->violations = 1;
    judged.report.audit->first.push_back({});
    judged.check_fails("1 audit violations");
  }
  SECTION("the audit covered too little") {
    judged.report.audit->coverage.time = 0.5;
    judged.check_fails("did not judge the run");
  }
  SECTION("the firmware broke a rule") {
    judged.report.firmware_violations = 1;
    judged.check_fails("1 firmware violations");
  }
  SECTION("nothing was granted") {
    judged.report.grants = 0;
    judged.check_fails("no coordinator ever granted");
  }
  SECTION("a robot does not drive") {
    judged.progress[2].agent_state = GENERATE(msg::AgentState::AGENT_WAITING, msg::AgentState::AGENT_ABSENT,
                                              msg::AgentState::AGENT_CLOCK_OUT_OF_BOUND);
    judged.check_fails("robots 2 do not drive");
  }
  SECTION("a robot was never heard") {
    judged.progress[1].agent_state.reset();
    judged.check_fails("robots 1 do not drive");
  }
  SECTION("a clock out of bounds was not detected") {
    const RobotEnd end = GENERATE(RobotEnd::kClockOutOfBound, RobotEnd::kClockLeftBound);
    judged.end(1, end, msg::AgentState::AGENT_DRIVING);
    judged.progress[1].grants = 0;
    judged.check_fails("the agents of robots 1 do not detect");
  }
  SECTION("a robot was driven although its clock was far out of bounds") {
    judged.end(1, RobotEnd::kClockOutOfBound, msg::AgentState::AGENT_CLOCK_OUT_OF_BOUND);
    judged.trial.scenario.robots[1].clock_offset = 30s;
    judged.check_fails("robots 1 were driven");
  }
  SECTION("a robot off the floor was not reported absent") {
    judged.end(0, RobotEnd::kLifted, msg::AgentState::AGENT_DRIVING);
    judged.check_fails("do not report that their robots are off the floor");
  }
  SECTION("no robot moves") {
    judged.result.stationary = 3;
    judged.check_fails("no robot moves");
  }
}

TEST_CASE("the audit judges every trial in which no process believed a second simulator") {
  Judged judged;
  judged.report.audit->coverage.time = 0.5;
  judged.report.audit->violations = 1;
  judged.report.audit->first.push_back({});
  judged.result.is_audited = false;
  CHECK(judged.failures().empty());
  judged.result.is_audited = true;
  CHECK_FALSE(judged.failures().empty());
}

TEST_CASE("robots that need not move may rest, and all robots may rest at their goals") {
  Judged judged;
  judged.result.stationary = 3;
  judged.has_arrived = true;
  CHECK(judged.failures().empty());
  judged.has_arrived = false;
  judged.end(1, RobotEnd::kTakenAway, msg::AgentState::AGENT_DRIVING);
  judged.check_fails("no robot moves");
  judged.end(1, RobotEnd::kLifted, msg::AgentState::AGENT_ABSENT);
  judged.check_fails("no robot moves");
  judged.end(1, RobotEnd::kClockBeyondBound, msg::AgentState::AGENT_DRIVING);
  CHECK(judged.failures().empty());
}

}  // namespace sidestep::trial_test
