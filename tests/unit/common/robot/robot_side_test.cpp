// SPDX-License-Identifier: Apache-2.0
#include "common/robot/robot_side.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "common/messaging/version_codec.hpp"
#include "common/random/rng.hpp"
#include "common/robot/conversion.hpp"
#include "tests/catch.hpp"
#include "tests/counted_allocations.hpp"
#include "tests/unit/common/robot/test_memory.hpp"

namespace sidestep::robot {

using test::at_ms;
using test::command;
using test::rest_version;
using test::TestMemory;

namespace {

/// Accelerates from the base's state at start_ms for 100 ms, then brakes.
Version driving_version(const Version& base, std::uint64_t number, std::int64_t start_ns,
                        const Vec2& acceleration) {
  const auto from = motion_at<double>(base, start_ns);
  sidestep::Version version;
  version.incarnation = 100;
  version.number = number;
  version.base = base.number;
  version.trajectory = Trajectory(time_from_ns(start_ns), {{from.position_m.x, from.position_m.y},
                                                           {from.velocity_mps.x, from.velocity_mps.y}});
  version.trajectory.append(std::chrono::milliseconds(100), acceleration);
  append_stop(version.trajectory, 5);
  return to_plain(version);
}

template <typename Real>
Estimate<Real> exactly_at(const Version& version, std::int64_t t_ns) {
  const auto motion = motion_at<Real>(version, t_ns);
  Estimate<Real> estimate;
  estimate.position_m = motion.position_m;
  estimate.velocity_mps = motion.velocity_mps;
  return estimate;
}

}  // namespace

TEMPLATE_TEST_CASE("the robot side repeats every version bit for bit and allocates nothing", "", float,
                   double) {
  Rng rng(24);
  TestMemory memory;
  RobotSide<TestType> side({}, {});
  side.begin_at_rest(1.25, -0.7);
  std::vector<Version> sent;
  sent.reserve(1000);
  int compared = 0;
  std::uint64_t number = 100;
  const std::size_t allocations = allocation_count();
  for (std::int64_t ms = 1; ms <= 5000; ++ms) {
    if (ms % 16 == 0) {
      const Vec2 acceleration(rng.uniform(-2.0, 2.0), rng.uniform(-2.0, 2.0));
      sent.push_back(driving_version(side.executing(), ++number, at_ms(ms + 5), acceleration));
      (void)side.on_command(command(100, 1, &sent.back()), at_ms(ms), memory);
    }
    side.check_reference(at_ms(ms), exactly_at<TestType>(side.executing(), at_ms(ms)), memory);
    const RobotReport robot_report = side.robot_report(at_ms(ms));
    if (robot_report.executing->number == 0) continue;
    const Version& original = sent[robot_report.executing->number - 101];
    REQUIRE(robot_report.executing->number == original.number);
    const bool is_same = robot_report.executing->x_m == original.x_m &&
                         robot_report.executing->vy_mps == original.vy_mps &&
                         robot_report.executing->phases[0].ax_mps2 == original.phases[0].ax_mps2 &&
                         robot_report.executing->phases[1].ay_mps2 == original.phases[1].ay_mps2;
    compared += is_same ? 1 : 0;
    REQUIRE(is_same);
  }
  CHECK(allocation_count() == allocations);
  CHECK(compared > 4900);
  CHECK(side.own_stops() == 0);
  CHECK(side.counts().activated == sent.size() - (sent.back().start_ns > at_ms(5000) ? 1 : 0));
}

TEMPLATE_TEST_CASE("a robot's own stop brakes to rest from its estimate", "", float, double) {
  Rng rng(25);
  for (int i = 0; i < 500; ++i) {
    TestMemory memory;
    RobotSide<TestType> side({}, {});
    side.begin_at_rest(0, 0);
    Estimate<TestType> pushed;
    pushed.position_m = {static_cast<TestType>(rng.uniform(0.1, 5.0)),
                         static_cast<TestType>(rng.uniform(-5.0, 5.0))};
    pushed.velocity_mps = {static_cast<TestType>(rng.uniform(-2.0, 2.0)),
                           static_cast<TestType>(rng.uniform(-2.0, 2.0))};
    REQUIRE(side.needs_uncertainty(at_ms(1), pushed.position_m));
    pushed.position_error_rms_m = TestType(0.01);
    side.check_reference(at_ms(1), pushed, memory);
    REQUIRE(side.is_off_reference());
    CHECK(side.own_stop_reason() == OwnStopReason::kOffReference);
    const sidestep::Version stop = from_plain(side.executing(), 0);
    const State& from = stop.trajectory.at_start();
    CHECK(from.position_m == Vec2(pushed.position_m.x, pushed.position_m.y));
    CHECK(from.velocity_mps == Vec2(pushed.velocity_mps.x, pushed.velocity_mps.y));
    CHECK(stop.trajectory.residual_speed_mps() < 1e-9);
    REQUIRE(stop.trajectory.phases().size() == 1);
    const Vec2 braking = stop.trajectory.phases()[0].acceleration_mps2;
    CHECK(braking.norm() == Approx(5).epsilon(1e-6));
    CHECK(std::abs(cross(braking, from.velocity_mps)) < 1e-9);
    CHECK(braking.dot(from.velocity_mps) < 0);
    CHECK(stop.inflation_m == Approx(0.02).epsilon(1e-6));
  }
}

TEST_CASE("a robot with slow motors refuses versions that start too soon and reports its lead") {
  TestMemory memory;
  Settings<double> settings;
  settings.actuation_lead_ns = 100'000'000;
  RobotSide<double> side(settings, {});
  side.begin_at_rest(0, 0);
  const Version soon = rest_version(101, 0, 100), in_time = rest_version(102, 0, 101);
  CHECK(side.on_command(command(100, 1, &soon), at_ms(0), memory));
  CHECK(side.counts().refused_late == 1);
  CHECK(side.on_command(command(100, 1, &in_time), at_ms(0), memory));
  CHECK(side.robot_report(at_ms(101)).executing->number == 102);
  CHECK(side.robot_report(at_ms(101)).lead_ns == 100'000'000);
}

TEST_CASE("the own stop of a robot with slow motors begins with the motion already under way") {
  TestMemory memory;
  Settings<double> settings;
  settings.actuation_lead_ns = 100'000'000;
  RobotSide<double> side(settings, {});
  side.begin_at_rest(0, 0);
  Estimate<double> estimate;
  estimate.position_m = {1, 0};
  estimate.velocity_mps = {0.9, 0};
  estimate.position_error_rms_m = 0.001;
  estimate.jump_m = 0.002;
  estimate.under_way.from_mps = {1, 0};
  estimate.under_way.part_count = 2;
  estimate.under_way.parts[0] = {60'000'000, {1.6, 0}};
  estimate.under_way.parts[1] = {40'000'000, {1.2, 0.5}};
  estimate.under_way.error_m = 0.003;
  REQUIRE(side.is_stop_due(at_ms(1), estimate));
  side.check_reference(at_ms(1), estimate, memory);
  REQUIRE(side.is_off_reference());
  const Version& stop = side.executing();
  REQUIRE(stop.phase_count == 3);
  CHECK(stop.vx_mps == 1);
  const auto between = motion_at<double>(stop, at_ms(61)), braked = motion_at<double>(stop, at_ms(101));
  CHECK(between.velocity_mps.x == Approx(1.6));
  CHECK(between.position_m.x == Approx(1 + 0.078));
  CHECK(braked.velocity_mps.x == Approx(1.2));
  CHECK(braked.velocity_mps.y == Approx(0.5));
  CHECK(braked.position_m.x == Approx(1 + 0.078 + 0.056));
  CHECK(braked.position_m.y == Approx(0.01));
  CHECK(stop.end_ns() == at_ms(101 + 260));  // starting at 1.3 m/s
  CHECK(stop.inflation_m == Approx(0.007));
}

TEST_CASE("the own stop of a robot with immediate motors ignores motion under way") {
  TestMemory memory;
  RobotSide<double> side({}, {});
  side.begin_at_rest(0, 0);
  Estimate<double> estimate;
  estimate.position_m = {1, 0};
  estimate.velocity_mps = {1, 0};
  estimate.under_way.from_mps = {2, 0};
  estimate.under_way.part_count = 1;
  estimate.under_way.parts[0] = {60'000'000, {1.6, 0}};
  estimate.under_way.error_m = 0.003;
  side.check_reference(at_ms(1), estimate, memory);
  REQUIRE(side.executing().phase_count == 1);
  CHECK(side.executing().vx_mps == 1);
  CHECK(side.executing().inflation_m == 0);
}

TEMPLATE_TEST_CASE("a robot whose estimated pose or velocity is not finite has no pose", "", float, double) {
  using Number = std::numeric_limits<TestType>;
  const TestType bad = GENERATE(Number::quiet_NaN(), Number::infinity(), -Number::infinity());
  const int field = GENERATE(range(0, 7));
  CAPTURE(bad, field);
  TestMemory memory;
  Settings<TestType> settings;
  settings.actuation_lead_ns = field < 4 ? 0 : 50'000'000;
  RobotSide<TestType> side(settings, {});
  side.begin_at_rest(0, 0);
  REQUIRE(side.may_report());
  Estimate<TestType> estimate;
  // The motion under way is read only for an own stop, which an error of 1 m causes.
  if (field >= 4) estimate.position_m.x = 1;
  estimate.under_way.part_count = 1;
  estimate.under_way.parts[0].duration_ns = 50'000'000;
  TestType* const fields[] = {&estimate.position_m.x,
                              &estimate.position_m.y,
                              &estimate.velocity_mps.x,
                              &estimate.velocity_mps.y,
                              &estimate.under_way.from_mps.x,
                              &estimate.under_way.from_mps.y,
                              &estimate.under_way.parts[0].end_velocity_mps.y};
  *fields[field] = bad;
  side.check_reference(at_ms(1), estimate, memory);
  CHECK_FALSE(side.has_pose());
  CHECK_FALSE(side.may_report());
  CHECK_FALSE(side.is_off_reference());
  // The robot accepts no version until it has found its pose, where it makes an own stop.
  const Version version = rest_version(101, 0, 50);
  CHECK(side.on_command(command(100, 1, &version), at_ms(2), memory));
  CHECK_FALSE(side.has_pending());
  side.find_pose();
  Estimate<TestType> found;
  found.position_m.x = 2;
  side.check_reference(at_ms(3), found, memory);
  CHECK(side.may_report());
  CHECK(side.is_off_reference());
  CHECK(side.executing().x_m == 2);
}

TEMPLATE_TEST_CASE("a robot that does not know its position error stops with the maximum inflation", "",
                   float, double) {
  const TestType nan = std::numeric_limits<TestType>::quiet_NaN();
  TestMemory memory;
  RobotSide<TestType> side({}, {});
  side.begin_at_rest(0, 0);
  Estimate<TestType> estimate;
  SECTION("the position error is not finite") {
    estimate.position_m.x = TestType(0.004);  // within the bound if there were no uncertainty
    estimate.position_error_rms_m = nan;
    REQUIRE(side.needs_uncertainty(at_ms(1), estimate.position_m));
  }
  SECTION("the displacement is not finite") {
    estimate.position_m.x = TestType(0.0031);
    estimate.jump_m = nan;
  }
  CHECK(side.is_stop_due(at_ms(1), estimate));
  side.check_reference(at_ms(1), estimate, memory);
  CHECK(side.is_off_reference());
  CHECK(side.executing().inflation_m == 1);
}

TEST_CASE("a robot does not plan to switch to a version that it will refuse") {
  TestMemory memory;
  RobotSide<double> side({}, {});
  side.begin_at_rest(0, 0);
  const Version first = rest_version(105, 0, 20), lower = rest_version(104, 105, 40),
                next = rest_version(106, 105, 60);
  for (const Version* version : {&first, &lower, &next})
    REQUIRE(side.on_command(command(100, 1, version), at_ms(1), memory));
  for (std::int64_t ms = 2; ms < 80; ++ms) {
    const std::uint64_t planned = side.planned(at_ms(ms + 5)).number;
    RobotSide<double> later = side;
    CHECK(planned == later.robot_report(at_ms(ms + 5)).executing->number);
    while (side.switch_next(at_ms(ms))) {
    }
  }
  CHECK(side.executing().number == 106);
}

TEST_CASE("a robot that is power-cycled while being carried is put down at its rest version") {
  TestMemory memory;
  RobotSide<double> side({}, {});
  side.begin_at_rest(0, 0);
  side.lift(at_ms(1), 0, 0);
  side.switch_on();
  Version place = rest_version(101, 0, 20);
  place.x_m = 3;
  REQUIRE(side.on_command(command(100, 1, &place), at_ms(10), memory));
  REQUIRE(side.robot_report(at_ms(20)).executing->number == 101);
  side.put_down();
  Estimate<double> there;
  there.position_m.x = 3;
  side.check_reference(at_ms(30), there, memory);
  CHECK_FALSE(side.is_off_reference());
  CHECK(side.own_stops() == 0);
  CHECK(side.robot_report(at_ms(31)).executing->number == 101);
}

TEST_CASE("a robot without a pose accepts no version") {
  TestMemory memory;
  RobotSide<double> side({}, {});
  const Version version = rest_version(101, 0, 50);
  CHECK(side.on_command(command(100, 1, &version), at_ms(1), memory));
  CHECK_FALSE(side.has_pending());
  CHECK_FALSE(side.may_report());
  side.check_reference(at_ms(2), {}, memory);
  CHECK_FALSE(side.is_off_reference());
  side.find_pose();
  CHECK_FALSE(side.may_report());  // no version begins at its pose yet
  side.check_reference(at_ms(3), {}, memory);
  CHECK(side.may_report());
  CHECK(side.is_off_reference());
  CHECK(side.own_stop_reason() == OwnStopReason::kRestart);
}

TEST_CASE("a robot whose clock is set back makes an own stop numbered above all versions it received") {
  const std::int64_t back_ns = GENERATE(1'000'000, 5'000'000'000, 3'500'000'000'000);
  CAPTURE(back_ns);
  TestMemory memory;
  RobotSide<double> side({}, {});
  side.begin_at_rest(1, 2);
  const std::int64_t before_ns = at_ms(4'000'000), now_ns = before_ns - back_ns;
  const Version first = driving_version(side.executing(), 101, before_ns - 20'000'000, {2, 0});
  (void)side.on_command(command(100, 1, &first), before_ns - 30'000'000, memory);
  REQUIRE(side.robot_report(before_ns).executing->number == 101);
  const Version pending = driving_version(side.executing(), 102, before_ns + 10'000'000, {2, 0});
  (void)side.on_command(command(100, 1, &pending), before_ns, memory);
  REQUIRE(side.has_pending());
  const auto estimate = exactly_at<double>(first, before_ns);

  side.set_clock_back(now_ns);
  CHECK_FALSE(side.may_report());
  CHECK_FALSE(side.has_pending());
  // The command arrives again before the robot has made its stop.
  (void)side.on_command(command(100, 1, &pending), now_ns, memory);
  CHECK_FALSE(side.has_pending());
  side.check_reference(now_ns + 1'000'000, estimate, memory);
  REQUIRE(side.may_report());
  CHECK(side.own_stops() == 1);
  CHECK(side.own_stop_reason() == OwnStopReason::kClockSetBack);
  const RobotReport robot_report = side.robot_report(now_ns + 1'000'000);
  CHECK(robot_report.executing->start_ns == now_ns + 1'000'000);
  CHECK(robot_report.executing->number >= 102 + RobotSide<double>::kOwnNumberGap);
  CHECK(robot_report.executing->vx_mps == estimate.velocity_mps.x);
  // By the new clock, `pending` would be in time, but it was granted according to the old clock.
  (void)side.on_command(command(100, 1, &pending), now_ns + 2'000'000, memory);
  CHECK_FALSE(side.switch_next(before_ns + 20'000'000));
}

TEST_CASE("a lifted robot whose clock is set back stays lifted and has no pending version") {
  TestMemory memory;
  RobotSide<double> side({}, {});
  side.begin_at_rest(1, 2);
  // The robot is lifted before it can make its own stop.
  side.set_clock_back(at_ms(5000));
  side.lift(at_ms(5000), 1, 2);
  REQUIRE(side.may_report());
  const Version rest = rest_version(101, 0, 5100);
  (void)side.on_command(command(100, 1, &rest), at_ms(5001), memory);
  side.set_clock_back(at_ms(1000));
  CHECK(side.is_lifted());
  CHECK(side.may_report());
  CHECK_FALSE(side.has_pending());
  CHECK(side.robot_report(at_ms(1000)).executing->start_ns == at_ms(1000));
}

}  // namespace sidestep::robot
