// SPDX-License-Identifier: Apache-2.0
// Single world states from vision as evidence, without ground truth.
#include <cmath>

#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/stage.hpp"

namespace sidestep::auditor_sights_test {

using namespace std::chrono_literals;

constexpr AuditInput kIncomplete{};

/// A stage whose cameras show both robots in place unless a test changes that.
struct Seen : Stage {
  explicit Seen(const AuditInput& input = kComplete, double inflation_m = 0)
      : Seen(stage_scenario(), input, inflation_m) {}
  Seen(const Scenario& staged, const AuditInput& input, double inflation_m = 0) : Stage(staged, input) {
    world.robots().resize(2);
    for (RobotId robot = 0; robot < 2; ++robot) {
      robot_reports[robot].executing().inflation_m(inflation_m);
      world.robots()[robot].robot(robot);
      place(robot, scenario.robots[robot].start_m);
    }
    begin();
    // The run is judged from now on.
    msg::CoordinatorState state;
    state.header(header("coordinator", kCoordinator));
    state.epoch(epoch);
    state.coordinator_mode(msg::CoordinatorMode::COORDINATOR_GRANTING);
    auditor.on_coordinator(state, now);
  }
  void place(RobotId robot, const Vec2& at_m) {
    world.robots()[robot].x_m(at_m.x());
    world.robots()[robot].y_m(at_m.y());
    world.robots()[robot].observed_x_m(at_m.x());
    world.robots()[robot].observed_y_m(at_m.y());
  }
  void show() {
    msg::WorldState message = world;
    message.header(header("world", 20'000));
    message.valid_at_ns(to_ns(now));
    for (msg::TrackedRobot& robot : message.robots()) robot.observed_at_ns(to_ns(now));
    auditor.on_world_state(message, now);
  }
  void run(Duration duration) {
    for (const Time end = now + duration; now < end;) {
      advance(16ms);
      show();
      advance(1ms);
      for (RobotId robot = 0; robot < 2; ++robot) report(robot);
    }
  }
  void disturb(RobotId robot, msg::DisturbanceKind kind, Duration duration = Duration{0},
               RobotId other = 99) {
    msg::Disturbance disturbance;
    disturbance.robot(robot);
    disturbance.other_robot(other);
    disturbance.disturbance_kind(kind);
    disturbance.duration_ns(duration.count());
    auditor.on_disturbance(disturbance, now);
  }
  /// The error that vision and clocks may add to the tracking bound.
  double allowance_m() const {
    return 4 * scenario.vision.position_noise_m + 2 * scenario.clock_bound_s * scenario.limits.speed_mps;
  }
  std::uint64_t position() const { return count(AuditRule::kPosition); }
  std::uint64_t contact() const { return count(AuditRule::kContact); }

  msg::WorldState world;
};

TEST_CASE("vision becomes the reference after it has shown robots for a second") {
  Seen seen;
  seen.world.robots().clear();
  seen.run(2s);
  CHECK(seen.auditor.totals().reference == AuditReference::kNone);
  seen.world = Seen().world;
  const Time first = seen.now + 16ms;
  while (seen.now < first + 950ms) seen.run(17ms);
  CHECK(seen.auditor.totals().reference == AuditReference::kNone);
  seen.run(100ms);
  CHECK(seen.auditor.totals().reference == AuditReference::kVision);
  CHECK(seen.violations.empty());
}

TEST_CASE("a robot that vision shows out of place for longer than 300 ms is reported once") {
  const bool is_complete = GENERATE(true, false);
  const double inflation_m = GENERATE(0.0, 0.02);
  Seen seen(is_complete ? kComplete : kIncomplete, inflation_m);
  seen.run(2s);
  REQUIRE(seen.violations.empty());
  const double bound_m = seen.scenario.tracking_bound_m + inflation_m + seen.allowance_m();
  const auto [excess_m, duration, is_reported] = GENERATE(table<double, Duration, bool>(
      {{-1e-4, 1s, false}, {1e-4, 1s, true}, {0.1, 290ms, false}, {0.1, 340ms, true}, {0.1, 2s, true}}));
  CAPTURE(inflation_m, excess_m, to_seconds(duration));
  const double angle_rad = GENERATE(0.0, 2.0, 4.0);
  const Vec2 home = seen.scenario.robots[0].start_m;
  seen.place(0, home + rotated({bound_m + excess_m, 0}, angle_rad));
  seen.run(duration);
  seen.place(0, home);
  seen.run(200ms);
  CHECK(seen.position() == (is_reported ? 1 : 0));
  CHECK(seen.violations.size() == seen.position());
  CHECK(seen.auditor.totals().max_position_error_m == Approx(bound_m + excess_m));
  // A later displacement is reported separately.
  seen.place(0, home + Vec2(0.2, 0.2));
  seen.run(400ms);
  CHECK(seen.position() == (is_reported ? 2 : 1));
}

TEST_CASE("a displacement is reported only if it lasts without interruption") {
  const bool is_complete = GENERATE(true, false);
  Seen seen(is_complete ? kComplete : kIncomplete);
  seen.run(2s);
  const Vec2 home = seen.scenario.robots[0].start_m, away = home + Vec2(0.1, 0);
  seen.place(0, away);
  seen.run(250ms);
  std::uint64_t expected = 0;
  SECTION("an observation in place interrupts the displacement") {
    seen.place(0, home);
    seen.run(17ms);
    seen.place(0, away);
  }
  SECTION("a report that the robot is off its reference interrupts the displacement") {
    seen.robot_reports[0].is_off_reference(true);
    seen.run(17ms);
    seen.robot_reports[0].is_off_reference(false);
  }
  SECTION("a missed report interrupts the displacement") {
    (void)seen.header("feedback", 0);
    expected = is_complete ? 1 : 0;
  }
  SECTION("a clock out of bounds interrupts the displacement") {
    seen.advance(16ms);
    seen.show();
    seen.robot_reports[0].valid_at_ns(to_ns(seen.now + 50ms));
    seen.report(0);
    seen.robot_reports[0].valid_at_ns(0);
  }
  SECTION("nothing interrupts the displacement") { expected = 1; }
  seen.run(150ms);
  CHECK(seen.position() == expected);
}

TEST_CASE("an auditor that joins a run does not report robots displaced before it joined") {
  const bool is_complete = GENERATE(true, false);
  Seen seen(is_complete ? kComplete : kIncomplete);
  seen.place(0, {-1.3, 0});
  seen.run(3s);
  CHECK(seen.position() == (is_complete ? 1 : 0));
}

TEST_CASE(
    "an announced disturbance excuses displacements until it has ended and the robot is back in place") {
  Seen seen;
  seen.run(2s);
  std::uint64_t expected = 0;
  SECTION("a push") { seen.disturb(0, msg::DisturbanceKind::DISTURBANCE_PUSH); }
  SECTION("a push of another robot") {
    seen.disturb(1, msg::DisturbanceKind::DISTURBANCE_PUSH);
    expected = 1;
  }
  SECTION("a camera mistakes the robot for another") {
    seen.disturb(0, msg::DisturbanceKind::DISTURBANCE_SEEN_AS, 5s, 1);
  }
  SECTION("a long slip that is mostly over") {
    seen.disturb(0, msg::DisturbanceKind::DISTURBANCE_SLIP, 10s);
    seen.run(9s);
  }
  SECTION("a short slip long ago") {
    seen.disturb(0, msg::DisturbanceKind::DISTURBANCE_SLIP, 1s);
    seen.run(9s);
    expected = 1;
  }
  SECTION("a slip of negative length long ago") {
    seen.disturb(0, msg::DisturbanceKind::DISTURBANCE_SLIP, -5s);
    seen.run(3s);
    expected = 1;
  }
  SECTION("no disturbance") { expected = 1; }
  seen.place(0, {-1.3, 0.2});
  seen.run(500ms);
  CHECK(seen.position() == expected);
  CHECK((seen.auditor.totals().excused_displacements > 0) == (expected == 0));
}

TEST_CASE("with ground truth, an operator's message does not decide whether a robot is disturbed") {
  Seen seen;
  msg::GroundTruth truth;
  truth.robots().resize(1);
  truth.robots()[0].disturbance_end_ns(-1);
  truth.robots()[0].x_m(-1);
  const auto show_truth = [&] {
    truth.header(seen.header("truth", 30'000));
    truth.valid_at_ns(to_ns(seen.now));
    seen.auditor.on_truth(truth, seen.now);
    seen.advance(1ms);
    seen.report(0);
  };
  show_truth();
  seen.disturb(0, msg::DisturbanceKind::DISTURBANCE_PUSH);
  truth.robots()[0].x_m(-1.3);
  truth.robots()[0].reference_error_m(0.3);
  show_truth();
  CHECK(seen.position() == 1);
}

TEST_CASE("once ground truth has replaced vision, vision is not used") {
  Seen seen;
  seen.run(2s);
  msg::GroundTruth truth;
  truth.robots().resize(1);
  truth.robots()[0].x_m(-1);
  truth.robots()[0].disturbance_end_ns(-1);
  const auto run_with_truth = [&](Duration duration) {
    for (const Time end = seen.now + duration; seen.now < end;) {
      truth.header(seen.header("truth", 30'000));
      truth.valid_at_ns(to_ns(seen.now));
      seen.auditor.on_truth(truth, seen.now);
      seen.run(17ms);
    }
  };
  run_with_truth(1s);
  seen.place(0, {-1.5, 0});
  run_with_truth(1s);
  CHECK(seen.violations.empty());
  CHECK(seen.auditor.totals().reference == AuditReference::kVisionThenGroundTruth);
  CHECK(seen.auditor.totals().coverage.reference == Approx(1).margin(0.01));
  truth.robots()[0].x_m(-1.5);
  truth.robots()[0].reference_error_m(0.5);
  run_with_truth(100ms);
  CHECK(seen.position() > 1);
}

TEST_CASE("the silence of a robot that is switched off does not lower the coverage") {
  const auto kind =
      GENERATE(msg::DisturbanceKind::DISTURBANCE_SWITCH_OFF, msg::DisturbanceKind::DISTURBANCE_PUSH);
  Seen seen(kIncomplete);
  seen.run(2s);
  seen.disturb(0, kind);
  for (int i = 0; i < 200; ++i) {
    seen.advance(10ms);
    seen.report(1);
  }
  const bool is_off = kind == msg::DisturbanceKind::DISTURBANCE_SWITCH_OFF;
  CHECK(seen.auditor.totals().coverage.time == Approx(is_off ? 1 : 0.5).margin(0.02));
}

TEST_CASE("a contact seen by vision is reported unless a disturbance excuses it") {
  Seen seen;
  seen.run(2s);
  SECTION("two robots touch") {
    seen.place(0, {1 - 0.17, 0});
    seen.run(100ms);
    REQUIRE(seen.contact() == 1);
    CHECK(seen.violations.front().robot == 0);
    CHECK(seen.violations.front().epoch == 0);
    CHECK_THAT(seen.violations.front().detail, ContainsSubstring("touches robot 1"));
  }
  SECTION("two robots touch after a push") {
    seen.disturb(1, msg::DisturbanceKind::DISTURBANCE_PUSH);
    seen.place(0, {1 - 0.17, 0});
    seen.run(100ms);
    CHECK(seen.contact() == 0);
    CHECK(seen.auditor.totals().excused_contacts == 1);
  }
}

TEST_CASE("a contact of a robot that was out of place before is undecided if messages may be missed") {
  const bool is_complete = GENERATE(true, false);
  const bool were_apart = GENERATE(true, false);
  CAPTURE(is_complete, were_apart);
  Scenario scenario = stage_scenario();
  // The robots touch if both are in place.
  scenario.robots[0].start_m = {1 - 0.17, 0};
  Seen seen(scenario, is_complete ? kComplete : kIncomplete);
  if (were_apart) seen.place(0, {-1, 0});
  seen.run(2s);
  seen.place(0, {1 - 0.17, 0});
  seen.run(100ms);
  // The robot may have come back while the two touched, or before it was observed.
  CHECK(seen.contact() == (is_complete ? 1 : 0));
  CHECK(seen.auditor.totals().undecided_contacts == (is_complete ? 0 : 1));
}

TEST_CASE("a contact in two world states counts only if no world state was missed in between") {
  const bool is_complete = GENERATE(true, false);
  Seen seen(is_complete ? kComplete : kIncomplete);
  seen.run(2s);
  seen.place(0, {1 - 0.17, 0});
  seen.run(17ms);
  const bool is_missed = GENERATE(true, false);
  if (is_missed) (void)seen.header("world", 20'000);
  seen.run(17ms);
  CHECK(seen.contact() + seen.auditor.totals().undecided_contacts == (is_missed && !is_complete ? 0 : 1));
}

TEST_CASE("an observation with NaN, infinity or an unknown robot is counted as invalid and not used") {
  Seen seen;
  seen.run(2s);
  msg::TrackedRobot& robot = seen.world.robots()[0];
  SECTION("x") { robot.x_m(NAN); }
  SECTION("y") { robot.y_m(INFINITY); }
  SECTION("speed along x") { robot.vx_mps(NAN); }
  SECTION("speed along y") { robot.vy_mps(NAN); }
  SECTION("observed x") { robot.observed_x_m(NAN); }
  SECTION("observed y") { robot.observed_y_m(NAN); }
  SECTION("unknown robot") { robot.robot(GENERATE(2u, 4'000'000'000u)); }
  CHECK(seen.auditor.totals().invalid == 0);
  seen.advance(16ms);
  seen.show();
  CHECK(seen.auditor.totals().invalid == 1);
  seen.run(1s);
  CHECK(seen.auditor.totals().coverage.reference == Approx(0.5).margin(0.1));
  CHECK(seen.violations.empty());
}

TEST_CASE("an older observation does not replace a newer observation") {
  Seen seen;
  seen.run(2s);
  msg::WorldState late = seen.world;
  late.header(seen.header("world", 20'000));
  late.valid_at_ns(to_ns(seen.now));
  for (msg::TrackedRobot& robot : late.robots()) {
    robot.observed_at_ns(to_ns(seen.now) - 100'000'000);
    robot.observed_x_m(-2);
  }
  for (int i = 0; i < 60; ++i) {
    seen.advance(10ms);
    late.header(seen.header("world", 20'000));
    seen.auditor.on_world_state(late, seen.now);
    seen.report(0);
  }
  CHECK(seen.position() == 0);
}

TEST_CASE("a robot that is off the floor need not be seen") {
  const bool is_lifted = GENERATE(true, false);
  Seen seen;
  seen.run(2s);
  seen.robot_reports[0].is_lifted(is_lifted);
  seen.report(0);
  seen.world.robots().erase(seen.world.robots().begin());
  seen.run(2s);
  CHECK((seen.auditor.totals().coverage.reference == Approx(1)) == is_lifted);
}

}  // namespace sidestep::auditor_sights_test
