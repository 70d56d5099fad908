// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/robot_ends.hpp"

#include "common/config/scenario_loader.hpp"
#include "deploy/trial/simulate/campaign/trial.hpp"
#include "tests/catch.hpp"

namespace sidestep::robot_ends_test {

using namespace std::chrono_literals;
using Kind = msg::DisturbanceKind;

struct PlannedTrial {
  Scenario scenario =
      parse_scenario("field: {length_m: 6, width_m: 5}\ncircle: {count: 3, spacing_m: 0.6}\n", "three.yaml");
  FaultPlan plan;

  void disturb(Duration at, RobotId robot, Kind kind, Duration clock_offset = 0s) {
    RobotDisturbance disturbance;
    disturbance.robot = robot;
    disturbance.kind = kind;
    disturbance.clock_offset = clock_offset;
    plan.faults.push_back({at, disturbance});
  }
  std::map<RobotId, RobotEnd> ends(Duration simulator_started) const {
    return robot_ends(plan, scenario, simulator_started, 60s);
  }
};

TEST_CASE("robots end as planned if the first simulator lives until the end") {
  PlannedTrial planned;
  planned.plan.ends = {{0, RobotEnd::kClockLeftBound}, {1, RobotEnd::kLifted}, {2, RobotEnd::kTakenAway}};
  CHECK(planned.ends(0s) == planned.plan.ends);
}

TEST_CASE("a robot's clock drifts from the start of the last simulator") {
  PlannedTrial planned;
  planned.scenario.robots[0].clock_drift_ppm = 85;
  planned.plan.ends = {{0, RobotEnd::kClockLeftBound}};
  CHECK(planned.ends(48s).at(0) == RobotEnd::kClockBeyondBound);
  CHECK(planned.ends(1s).at(0) == RobotEnd::kClockLeftBound);
}

TEST_CASE("a robot's clock is wrong at the end only if the last simulator has set it") {
  PlannedTrial planned;
  planned.plan.ends = {{0, RobotEnd::kClockLeftBound}};
  planned.disturb(20s, 0, Kind::DISTURBANCE_CLOCK, 100ms);
  CHECK(planned.ends(10s).at(0) == RobotEnd::kClockLeftBound);
  CHECK(planned.ends(30s).at(0) == RobotEnd::kClockBeyondBound);
}

TEST_CASE("a lifted robot is on the floor again in a simulator that starts later") {
  PlannedTrial planned;
  planned.plan.ends = {{1, RobotEnd::kLifted}, {2, RobotEnd::kTakenAway}};
  planned.disturb(20s, 1, Kind::DISTURBANCE_LIFT);
  CHECK(planned.ends(10s) == planned.plan.ends);
  CHECK(planned.ends(30s) == std::map<RobotId, RobotEnd>{{2, RobotEnd::kTakenAway}});
}

TEST_CASE("the campaign does not expect a clock error that a later simulator has forgotten") {
  const Trial trial = sample_trial(175666644, 60s, std::nullopt);
  const TrialResult result = run_trial(trial);
  CAPTURE(result.failures);
  CHECK(result.failures.empty());
}

}  // namespace sidestep::robot_ends_test
