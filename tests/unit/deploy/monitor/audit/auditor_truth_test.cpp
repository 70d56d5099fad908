// SPDX-License-Identifier: Apache-2.0
// What single messages of ground truth prove.
#include <algorithm>

#include "tests/catch.hpp"
#include "tests/unit/deploy/monitor/audit/stage.hpp"

namespace sidestep::auditor_truth_test {

using namespace std::chrono_literals;

constexpr AuditInput kIncomplete{};

/// A stage whose simulator shows both robots in place, unless a test changes that.
struct Shown : Stage {
  explicit Shown(const AuditInput& input = kComplete, double inflation_m = 0)
      : Stage(stage_scenario(), input) {
    truth.robots().resize(2);
    for (RobotId robot = 0; robot < 2; ++robot) {
      truth.robots()[robot].robot(robot);
      facts[robot].executing().inflation_m(inflation_m);
      truth.robots()[robot].x_m(scenario.robots[robot].start_m.x());
      truth.robots()[robot].disturbance_end_ns(-1);
    }
    begin();
  }
  void show() { show(now); }
  void show(Time valid_at) {
    msg::GroundTruth message = truth;
    message.header(header("truth", 30'000, life));
    message.valid_at_ns(to_ns(valid_at));
    auditor.on_truth(message, now);
  }
  /// Ground truth, and then facts of both robots, which are compared with it.
  void run(Duration duration) {
    for (const Time end = now + duration; now < end;) {
      advance(10ms);
      show();
      advance(1ms);
      for (RobotId robot = 0; robot < 2; ++robot) report(robot);
    }
  }
  /// From now on the simulator counts one contact more.
  void touch(RobotId first, RobotId second) {
    msg::ContactPair& contact = truth.recent_contacts()[truth.contacts() % msg::MAX_CONTACTS];
    contact.first(first);
    contact.second(second);
    truth.contacts(truth.contacts() + 1);
  }
  void crash(RobotId robot) {
    truth.recent_moving_crashes()[truth.crashes_while_moving() % msg::MAX_CONTACTS] = robot;
    truth.crashes_while_moving(truth.crashes_while_moving() + 1);
  }
  void push(RobotId robot) { truth.robots()[robot].disturbance_end_ns(to_ns(now)); }
  std::uint64_t position() const { return count(AuditRule::kPosition); }

  msg::GroundTruth truth;
  Incarnation life = 800;
};

TEST_CASE(
    "a robot beyond the tracking bound and its inflation is reported, in ground truth and by its own facts") {
  const bool is_complete = GENERATE(true, false);
  const double inflation_m = GENERATE(0.0, 0.02);
  const auto [excess_m, is_reported] =
      GENERATE(table<double, bool>({{-0.004, false}, {0.9e-5, false}, {1.1e-5, true}, {0.01, true}}));
  CAPTURE(is_complete, inflation_m, excess_m);
  Shown shown(is_complete ? kComplete : kIncomplete, inflation_m);
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

TEST_CASE("a robot is not compared with its reference while it has none, or may have had none") {
  const bool is_complete = GENERATE(true, false);
  Shown shown(is_complete ? kComplete : kIncomplete);
  shown.run(50ms);
  REQUIRE(shown.violations.empty());
  shown.truth.robots()[0].x_m(-1.5);
  shown.truth.robots()[0].reference_error_m(0.5);
  std::uint64_t expected = 0;
  bool is_off_before = false, is_off_after = false;
  SECTION("off its reference before") { is_off_before = true; }
  SECTION("off its reference afterwards") { is_off_after = true; }
  SECTION("lifted before") {
    shown.facts[0].is_lifted(true);
    shown.report(0);
    shown.facts[0].is_lifted(false);
    shown.advance(1ms);
  }
  SECTION("lifted afterwards") {
    shown.show();
    shown.facts[0].is_lifted(true);
    shown.report(0);
    CHECK(shown.violations.empty());
    return;
  }
  SECTION("always on it") { expected = 1; }
  SECTION("a fact was missed in between") {
    (void)shown.header("feedback", 0);
    expected = is_complete ? 1 : 0;
  }
  if (is_off_before) {
    shown.facts[0].is_off_reference(true);
    shown.report(0);
    shown.facts[0].is_off_reference(false);
    shown.advance(1ms);
  }
  shown.show();
  shown.advance(1ms);
  shown.facts[0].is_off_reference(is_off_after);
  shown.report(0);
  shown.report(0);
  INFO(shown.lines());
  CHECK(shown.position() == expected);
  CHECK(shown.violations.size() == expected);
}

TEST_CASE("a fact is not compared with ground truth of a later time") {
  Shown shown;
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

TEST_CASE("the position of a moving robot is compared with its version at that time, by its own clock") {
  const Duration clock_ahead = GENERATE(0ms, 400ms, -400ms);
  CAPTURE(to_seconds(clock_ahead));
  Shown shown;
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
    shown.facts[0].valid_at_ns(to_ns(shown.now + clock_ahead));
    if (shown.facts[0].valid_at_ns() >= version.start_ns()) shown.facts[0].executing(version);
    shown.report(0);
  }
  INFO(shown.lines());
  CHECK(shown.position() == 0);
  CHECK(shown.auditor.totals().max_position_error_m < 1e-6);
  shown.truth.robots()[0].y_m(1.1);
  shown.facts[0].valid_at_ns(0);  // now
  shown.run(50ms);
  CHECK(shown.position() > 0);
}

TEST_CASE("a robot whose clock jumps is not compared at that moment") {
  Shown shown;
  shown.run(50ms);
  shown.truth.robots()[0].x_m(-1.5);
  shown.show();
  shown.advance(1ms);
  shown.facts[0].valid_at_ns(to_ns(shown.now + GENERATE(-300ms, 300ms)));
  shown.report(0);
  CHECK(shown.position() == 0);
}

TEST_CASE("a displaced robot is excused, one that nobody disturbed is not") {
  const bool is_disturbed = GENERATE(true, false);
  Shown shown;
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
  Shown shown;
  shown.run(50ms);
  if (was_disturbed) shown.push(0);
  // It is back in place, and moved a second time without any disturbance.
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

TEST_CASE("contacts are reported one by one, in the order in which ground truth lists them") {
  Shown shown;
  shown.run(50ms);
  shown.touch(0, 1);
  shown.run(20ms);
  CHECK(shown.count(AuditRule::kContact) == 1);
  shown.touch(1, msg::NO_ROBOT);
  shown.touch(1, 0);
  shown.run(20ms);
  REQUIRE(shown.count(AuditRule::kContact) == 3);
  CHECK(shown.violations[0].robot == 0);
  CHECK(shown.violations[1].robot == 1);
  CHECK(shown.violations[1].epoch == 0);
  CHECK_THAT(shown.violations[1].detail, ContainsSubstring("touches an obstacle"));
  CHECK_THAT(shown.violations[2].detail, ContainsSubstring("touches robot 0"));
  CHECK(shown.auditor.totals().unidentified_contacts == 0);
}

TEST_CASE("of many contacts at once the last eight are known") {
  const auto [added, unidentified] = GENERATE(table<int, std::uint64_t>({{8, 0}, {9, 1}, {20, 12}}));
  Shown shown;
  shown.run(50ms);
  for (int i = 0; i < added; ++i) shown.touch(0, 1);
  shown.run(20ms);
  CHECK(shown.count(AuditRule::kContact) == static_cast<std::uint64_t>(added) - unidentified);
  CHECK(shown.auditor.totals().unidentified_contacts == unidentified);
}

TEST_CASE("crashes of moving robots are reported, those that are not listed together") {
  Shown shown;
  shown.run(50ms);
  SECTION("one") {
    shown.crash(1);
    shown.run(20ms);
    REQUIRE(shown.count(AuditRule::kCrash) == 1);
    CHECK(shown.violations.front().robot == 1);
  }
  SECTION("eight") {
    for (int i = 0; i < 8; ++i) shown.crash(1);
    shown.run(20ms);
    CHECK(shown.count(AuditRule::kCrash) == 8);
  }
  SECTION("nine and more") {
    const int more = GENERATE(1, 5);
    for (int i = 0; i < 8 + more; ++i) shown.crash(1);
    shown.run(20ms);
    CHECK(shown.count(AuditRule::kCrash) == 9);
    CHECK(shown.violations.front().robot == 0);
  }
  SECTION("one of a robot that was pushed") {
    shown.push(1);
    shown.run(20ms);
    shown.crash(1);
    shown.crash(0);
    shown.run(20ms);
    CHECK(shown.auditor.totals().excused_crashes == 1);
    REQUIRE(shown.count(AuditRule::kCrash) == 1);
    CHECK(shown.violations.front().robot == 0);
  }
  SECTION("one of a robot that is not on the roster") {
    shown.crash(77);
    shown.run(20ms);
    CHECK(shown.count(AuditRule::kCrash) == 1);
  }
}

TEST_CASE("an auditor that joins a run judges only what happens from then on") {
  Shown shown(kIncomplete);
  for (int i = 0; i < 100; ++i) (void)shown.header("truth", 30'000, shown.life);
  shown.touch(0, 1);
  shown.crash(0);
  shown.truth.firmware_violations(0);
  shown.run(50ms);
  CHECK(shown.violations.empty());
  CHECK(shown.auditor.totals().undecided_contacts == 1);
  CHECK(shown.auditor.totals().undecided_crashes == 1);
  shown.touch(0, 1);
  shown.crash(1);
  shown.run(50ms);
  CHECK(shown.count(AuditRule::kContact) == 1);
  CHECK(shown.count(AuditRule::kCrash) == 1);
  CHECK(shown.violations.size() == 2);
}

TEST_CASE("a contact is undecided if the disturbance that excuses it may have been missed") {
  Shown shown(kIncomplete);
  shown.run(50ms);
  shown.push(0);
  shown.run(30ms);
  std::uint64_t undecided = 1;
  SECTION("a robot is not shown any more") { shown.truth.robots().resize(1); }
  SECTION("messages were missed while a robot was disturbed") {
    (void)shown.header("truth", 30'000, shown.life);
  }
  SECTION("nothing was missed") { undecided = 0; }
  shown.run(3s);
  shown.touch(0, 1);
  shown.run(50ms);
  CHECK(shown.auditor.totals().undecided_contacts == undecided);
  CHECK(shown.count(AuditRule::kContact) == 1 - undecided);
}

TEST_CASE(
    "a moving robot is excused until it can have braked, 0.2 s after it can have heard of a disturbance") {
  const auto is_excused_after = [](Duration duration) {
    Shown shown;
    shown.truth.robots()[1].vx_mps(1);
    shown.run(50ms);
    shown.push(0);
    shown.run(110ms);  // in place, and at rest
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

TEST_CASE("robots in contact may appear a millimetre apart, and then push each other no more") {
  const double apart_m = GENERATE(0.1805, 0.1815);
  Shown shown;
  shown.run(50ms);
  shown.push(0);
  shown.truth.robots()[0].x_m(1 - apart_m);
  shown.truth.robots()[0].reference_error_m(2 - apart_m);
  shown.run(20ms);
  shown.touch(0, 1);
  shown.run(3s);
  shown.touch(1, msg::NO_ROBOT);
  shown.run(20ms);
  CHECK(shown.count(AuditRule::kContact) == (apart_m < 0.181 ? 0 : 1));
}

TEST_CASE("the counters of every simulator begin anew") {
  Shown shown;
  shown.run(20ms);
  shown.touch(0, 1);
  shown.crash(1);
  shown.truth.firmware_violations(1);
  shown.run(50ms);
  REQUIRE(shown.violations.size() == 3);
  CHECK(shown.count(AuditRule::kFirmwareMonitor) == 1);
  SECTION("the same counters of the next simulator are of new events") {
    ++shown.life;
    shown.run(50ms);
    CHECK(shown.violations.size() == 6);
  }
  SECTION("higher counters of the same simulator are") {
    shown.truth.firmware_violations(3);
    shown.run(50ms);
    CHECK(shown.count(AuditRule::kFirmwareMonitor) == 2);
  }
  SECTION("lower counters are not") {
    shown.truth.contacts(0);
    shown.truth.crashes_while_moving(0);
    shown.truth.firmware_violations(0);
    shown.run(50ms);
    CHECK(shown.violations.size() == 3);
  }
  SECTION("of more than sixteen simulators the first is forgotten") {
    for (int i = 1; i < 16; ++i) {
      ++shown.life;
      shown.truth.contacts(0), shown.truth.crashes_while_moving(0), shown.truth.firmware_violations(0);
      shown.show();
    }
    shown.life -= 15;
    shown.truth.contacts(1);
    shown.show();
    CHECK(shown.violations.size() == 3);
    shown.life += 16;
    shown.truth.contacts(0);
    shown.show();
    shown.life -= 16;
    shown.truth.contacts(1);
    shown.show();
    CHECK(shown.violations.size() == 4);
  }
}

TEST_CASE("positions that are no numbers, or of no robot, are not used") {
  Shown shown;
  shown.run(50ms);
  msg::TrueRobotState& robot = shown.truth.robots()[0];
  robot.x_m(-1.5);
  SECTION("x") { robot.x_m(NAN); }
  SECTION("y") { robot.y_m(NAN); }
  SECTION("error") { robot.reference_error_m(NAN); }
  SECTION("no robot") { robot.robot(GENERATE(2u, 4'000'000'000u)); }
  shown.run(50ms);
  CHECK(shown.violations.empty());
}

TEST_CASE(
    "a robot is in place up to the tracking bound and its inflation, if a ledger has held its version") {
  // Robots that are back in place are no longer excused.
  const auto [off_m, is_in_place] = GENERATE(table<double, bool>({{0.004, true}, {0.006, false}}));
  CAPTURE(off_m);
  Shown shown;
  shown.run(50ms);
  shown.push(0);
  shown.truth.robots()[0].x_m(-1 + off_m);
  shown.truth.robots()[0].reference_error_m(off_m);
  bool expected = is_in_place;
  SECTION("in its version") {}
  SECTION("in a stop of its own") {
    msg::Version stop = shown.next(shown.rest(0), 9, 0ms);
    shown.facts[0].executing(stop);
    shown.facts[0].is_off_reference(true);
    expected = false;
  }
  SECTION("in a stop of its own that the ledger has held") {
    msg::Version stop = shown.next(shown.rest(0), 9, 0ms);
    shown.facts[0].executing(stop);
    shown.facts[0].is_off_reference(true);
    shown.run(10ms);
    shown.show_page({stop, shown.rest(1)});
  }
  SECTION("off the floor") {
    shown.facts[0].is_lifted(true);
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
