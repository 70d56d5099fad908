// SPDX-License-Identifier: Apache-2.0
// Single messages of ground truth as evidence.
#include <algorithm>

#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/ground_truth_stage.hpp"

namespace sidestep::auditor_truth_test {

using namespace std::chrono_literals;

constexpr AuditInput kIncomplete{};

TEST_CASE("a robot farther from its reference than the tracking bound plus its inflation is reported") {
  const bool is_complete = GENERATE(true, false);
  const double inflation_m = GENERATE(0.0, 0.02);
  const auto [excess_m, is_reported] =
      GENERATE(table<double, bool>({{-0.004, false}, {0.9e-5, false}, {1.1e-5, true}, {0.01, true}}));
  CAPTURE(is_complete, inflation_m, excess_m);
  GroundTruthStage shown(is_complete ? kComplete : kIncomplete, inflation_m);
  shown.run(50ms);
  const double error_m = shown.scenario.tracking_bound_m + inflation_m + excess_m;
  shown.truth.robots()[0].reference_error_m(error_m);
  const int direction = GENERATE(0, 1);
  if (direction == 0) shown.truth.robots()[0].x_m(-1 + error_m);
  if (direction == 1) shown.truth.robots()[0].y_m(-error_m);
  shown.run(40ms);
  INFO(shown.lines());
  CHECK((shown.position() > 0) == is_reported);
  CHECK(shown.violations.size() == shown.position());
  CHECK(shown.auditor.totals().max_position_error_m == Approx(error_m));
}

TEST_CASE("a robot is compared with its reference only if it was certainly on its reference throughout") {
  const bool is_complete = GENERATE(true, false);
  GroundTruthStage shown(is_complete ? kComplete : kIncomplete);
  shown.run(50ms);
  REQUIRE(shown.violations.empty());
  shown.truth.robots()[0].x_m(-1.5);
  shown.truth.robots()[0].reference_error_m(0.5);
  std::uint64_t expected = 0;
  bool is_off_before = false, is_off_after = false;
  SECTION("the robot was off its reference before") { is_off_before = true; }
  SECTION("the robot is off its reference afterwards") { is_off_after = true; }
  SECTION("the robot was lifted before") {
    shown.robot_reports[0].is_lifted(true);
    shown.report(0);
    shown.robot_reports[0].is_lifted(false);
    shown.advance(1ms);
  }
  SECTION("the robot is lifted afterwards") {
    shown.show();
    shown.robot_reports[0].is_lifted(true);
    shown.report(0);
    CHECK(shown.violations.empty());
    return;
  }
  SECTION("the robot was always on its reference") { expected = 1; }
  SECTION("a report was missed in between") {
    (void)shown.header("feedback", 0);
    expected = is_complete ? 1 : 0;
  }
  if (is_off_before) {
    shown.robot_reports[0].is_off_reference(true);
    shown.report(0);
    shown.robot_reports[0].is_off_reference(false);
    shown.advance(1ms);
  }
  shown.show();
  shown.advance(1ms);
  shown.robot_reports[0].is_off_reference(is_off_after);
  shown.report(0);
  shown.report(0);
  INFO(shown.lines());
  CHECK(shown.position() == expected);
  CHECK(shown.violations.size() == expected);
}

TEST_CASE("a robot report is not compared with later ground truth") {
  GroundTruthStage shown;
  shown.run(50ms);
  shown.truth.robots()[0].x_m(-1.5);
  shown.show(shown.now + 20ms);
  shown.advance(1ms);
  shown.report(0);
  CHECK(shown.position() == 0);
  shown.advance(20ms);
  shown.report(0);
  CHECK(shown.position() == 1);
}

TEST_CASE("a moving robot's position is compared with its version at that time by its own clock") {
  const Duration clock_ahead = GENERATE(0ms, 400ms, -400ms);
  CAPTURE(to_seconds(clock_ahead));
  GroundTruthStage shown;
  msg::Version version = shown.next(shown.rest(0), 1, 500ms);
  version.phase_count(2);
  version.phases()[0].duration_ns(1'000'000'000);
  version.phases()[0].ay_mps2(1);
  version.phases()[1].duration_ns(1'000'000'000);
  version.phases()[1].ay_mps2(-1);
  shown.grant(version);
  shown.command(version);
  const AuditPath path(version);
  for (int i = 0; i < 250; ++i) {
    shown.advance(10ms);
    // The clock is ahead from the beginning, so the robot drives earlier.
    const std::int64_t by_robot_ns = to_ns(shown.now + clock_ahead);
    shown.truth.robots()[0].y_m(path.at_ns(by_robot_ns).y);
    shown.show();
    shown.advance(3ms);
    shown.robot_reports[0].valid_at_ns(to_ns(shown.now + clock_ahead));
    if (shown.robot_reports[0].valid_at_ns() >= version.start_ns()) shown.robot_reports[0].executing(version);
    shown.report(0);
  }
  INFO(shown.lines());
  CHECK(shown.position() == 0);
  CHECK(shown.auditor.totals().max_position_error_m < 1e-6);
  shown.truth.robots()[0].y_m(1.1);
  shown.robot_reports[0].valid_at_ns(0);  // now
  shown.run(50ms);
  CHECK(shown.position() > 0);
}

TEST_CASE("a robot whose clock jumps is not compared at that moment") {
  GroundTruthStage shown;
  shown.run(50ms);
  shown.truth.robots()[0].x_m(-1.5);
  shown.show();
  shown.advance(1ms);
  shown.robot_reports[0].valid_at_ns(to_ns(shown.now + GENERATE(-300ms, 300ms)));
  shown.report(0);
  CHECK(shown.position() == 0);
}

TEST_CASE("a robot without a reference in the simulator may be out of place for 300 ms, as with vision") {
  const double unknown = GENERATE(-1.0, -0.01);
  GroundTruthStage shown;
  for (msg::TrueRobotState& robot : shown.truth.robots()) robot.reference_error_m(unknown);
  shown.run(100ms);
  CHECK(shown.violations.empty());
  shown.truth.robots()[0].x_m(-1.05);
  shown.run(250ms);
  CHECK(shown.violations.empty());
  shown.run(100ms);
  check_only(shown, AuditRule::kPosition, 1);
}

TEST_CASE("a displacement is excused only if the robot was disturbed") {
  const bool is_disturbed = GENERATE(true, false);
  GroundTruthStage shown;
  shown.run(50ms);
  if (is_disturbed) shown.push(0);
  shown.truth.robots()[0].x_m(-1.2);
  shown.truth.robots()[0].reference_error_m(0.2);
  shown.run(100ms);
  CHECK((shown.position() == 0) == is_disturbed);
  CHECK((shown.auditor.totals().excused_displacements > 0) == is_disturbed);
}

TEST_CASE("a robot that a coordinator names as displaced is excused if it was ever disturbed") {
  const auto [was_disturbed, named, is_excused] =
      GENERATE(table<bool, RobotId, bool>({{true, 0, true}, {false, 0, false}, {true, 1, false}}));
  CAPTURE(was_disturbed, named);
  GroundTruthStage shown;
  shown.run(50ms);
  if (was_disturbed) shown.push(0);
  // The robot is back in place. Then it is displaced again without a new disturbance.
  shown.run(2s);
  REQUIRE(shown.violations.empty());
  msg::CoordinatorState state;
  state.header(shown.header("coordinator", Stage::kCoordinator));
  state.epoch(shown.epoch);
  state.coordinator_mode(msg::CoordinatorMode::COORDINATOR_GRANTING);
  state.notices().emplace_back().robot(named);
  state.notices().back().is_displaced(true);
  shown.auditor.on_coordinator(state, shown.now);
  shown.truth.robots()[0].x_m(-1.2);
  shown.truth.robots()[0].vx_mps(1);
  shown.truth.robots()[0].reference_error_m(0.2);
  shown.run(50ms);
  CHECK((shown.position() == 0) == is_excused);
}

TEST_CASE("a moving robot is excused while it may still need time to hear of a disturbance and brake") {
  const auto is_excused_after = [](Duration duration) {
    GroundTruthStage shown;
    shown.truth.robots()[1].vx_mps(1);
    shown.run(50ms);
    shown.push(0);
    shown.run(110ms);  // the pushed robot is back in place and at rest
    shown.run(duration);
    shown.touch(0, 1);
    shown.run(20ms);
    return shown.count(AuditRule::kContact) == 0;
  };
  const MotionLimits limits = stage_scenario().limits;
  const Duration braking = from_seconds(limits.speed_mps / limits.deceleration_mps2) + 200ms;
  CHECK(is_excused_after(braking - 60ms));
  CHECK_FALSE(is_excused_after(braking + 60ms));
}

TEST_CASE("positions that are not finite or belong to unknown robots are not used") {
  GroundTruthStage shown;
  shown.run(50ms);
  msg::TrueRobotState& robot = shown.truth.robots()[0];
  robot.x_m(-1.5);
  SECTION("x") { robot.x_m(NAN); }
  SECTION("y") { robot.y_m(NAN); }
  SECTION("reference error") { robot.reference_error_m(NAN); }
  SECTION("unknown robot") { robot.robot(GENERATE(2u, 4'000'000'000u)); }
  shown.run(50ms);
  CHECK(shown.violations.empty());
}

TEST_CASE("a robot is back in place only within the tracking bound of a version that a ledger has held") {
  // Contacts of robots that are back in place are not excused.
  const auto [off_m, is_in_place] = GENERATE(table<double, bool>({{0.004, true}, {0.006, false}}));
  CAPTURE(off_m);
  GroundTruthStage shown;
  shown.run(50ms);
  shown.push(0);
  shown.truth.robots()[0].x_m(-1 + off_m);
  shown.truth.robots()[0].reference_error_m(off_m);
  bool expected = is_in_place;
  SECTION("the robot executes its version") {}
  SECTION("the robot executes its own stop") {
    msg::Version stop = shown.next(shown.rest(0), 9, 0ms);
    shown.robot_reports[0].executing(stop);
    shown.robot_reports[0].is_off_reference(true);
    expected = false;
  }
  SECTION("the robot executes its own stop, which the ledger has held") {
    msg::Version stop = shown.next(shown.rest(0), 9, 0ms);
    shown.robot_reports[0].executing(stop);
    shown.robot_reports[0].is_off_reference(true);
    shown.run(10ms);
    shown.show_page({stop, shown.rest(1)});
  }
  SECTION("the robot is off the floor") {
    shown.robot_reports[0].is_lifted(true);
    expected = false;
  }
  shown.run(3s);
  shown.violations.clear();
  shown.touch(0, 1);
  shown.run(50ms);
  CHECK((shown.count(AuditRule::kContact) == 1) == expected);
  CHECK((shown.auditor.totals().excused_contacts == 1) == !expected);
}

}  // namespace sidestep::auditor_truth_test
