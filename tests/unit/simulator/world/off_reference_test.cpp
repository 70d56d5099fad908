// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include "tests/catch.hpp"
#include "tests/unit/simulator/world/commands.hpp"
#include "tests/unit/simulator/world/ideal_agent.hpp"
#include "tests/unit/simulator/world/random_drive.hpp"

namespace sidestep::off_reference_test {

using std::chrono::milliseconds;
using test::disturbance;
using test::IdealAgent;
using test::separated_robots;

const Time kBegin = time_from_ns(1'700'000'000'000'000'000);

Scenario noisy(Scenario scenario) {
  scenario.vision.position_noise_m = 0.0015;
  scenario.vision.delay = milliseconds(35);
  scenario.tracking_bound_m = 0.005;
  return scenario;
}

struct Floor {
  Floor(const Scenario& s, std::uint64_t seed) : scenario(s), world(scenario, kBegin, seed) {
    for (std::size_t i = 0; i < world.robot_count(); ++i)
      agents.emplace_back(scenario, world, i, 100 * seed + i);
  }
  void run_for(Duration duration) {
    for (const Time end = now + duration; now < end;) {
      now += kPhysicsStep;
      world.advance(now);
      for (IdealAgent& agent : agents) agent.act(now);
    }
  }
  std::uint64_t own_stops(std::size_t robot) const { return world.firmware(robot).own_stops(); }
  std::uint64_t own_stops() const {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < world.robot_count(); ++i) sum += own_stops(i);
    return sum;
  }
  // Runs until the robot's next own stop, for at most a second. Returns the elapsed time.
  Duration run_until_own_stop(std::size_t robot) {
    const std::uint64_t before = own_stops(robot);
    const Time since = now;
    while (own_stops(robot) == before && now - since < milliseconds(1000)) run_for(kPhysicsStep);
    return now - since;
  }

  Scenario scenario;
  World world;
  std::vector<IdealAgent> agents;
  Time now = kBegin;
};

TEST_CASE("an undisturbed robot never makes an own stop") {
  const std::uint64_t seed = GENERATE(1, 2, 3);
  const bool is_noisy = GENERATE(false, true);
  CAPTURE(seed, is_noisy);
  Floor floor(is_noisy ? noisy(separated_robots(20)) : separated_robots(20), seed);
  floor.run_for(std::chrono::seconds(20));
  CHECK(floor.own_stops() == 0);
  CHECK(floor.world.firmware_violations() == 0);
  for (std::size_t i = 0; i < floor.world.robot_count(); ++i) {
    CAPTURE(floor.world.firmware(i).counts().refused_late, floor.world.firmware(i).counts().refused_base,
            floor.world.firmware(i).counts().refused_malformed);
    CHECK(floor.world.firmware(i).counts().activated > 1000);
  }
}

TEST_CASE("a robot seen rarely and late returns to its reference without an own stop") {
  const std::uint64_t seed = GENERATE(range<std::uint64_t>(1, 11));
  CAPTURE(seed);
  Scenario scenario = separated_robots(20);
  scenario.vision.delay = milliseconds(120);
  scenario.vision.miss_probability = 0.6;
  Floor floor(scenario, seed);
  floor.run_for(std::chrono::seconds(10));
  CHECK(floor.own_stops() == 0);
}

TEST_CASE("a pushed robot makes an own stop when the second frame after the push arrives") {
  const std::uint64_t seed = GENERATE(range<std::uint64_t>(1, 11));
  const bool drives = GENERATE(false, true);
  CAPTURE(seed, drives);
  Floor floor(separated_robots(1), seed);
  floor.agents[0].drives = drives;
  floor.run_for(milliseconds(2000));
  REQUIRE(floor.own_stops() == 0);
  auto push = disturbance(0, msg::DisturbanceKind::DISTURBANCE_PUSH);
  const Vec2 change = rotated(Vec2(0.3, 0), static_cast<double>(seed));
  push.push_mps = change;
  REQUIRE(floor.world.disturb(0, push, floor.now));
  const Duration delay = floor.run_until_own_stop(0);
  // The robot slides for 50 ms. Frames are captured every 17 ms and arrive 10 ms later.
  INFO("own stop after " << to_seconds(delay) * 1e3 << " ms");
  CHECK(delay < milliseconds(75));
  const Version stop = floor.world.firmware(0).executing();
  CHECK(floor.world.firmware(0).is_off_reference());
  CHECK(stop.incarnation == 1);
  CHECK(stop.inflation_m > 0);
  CHECK(stop.trajectory.residual_speed_mps() < 1e-9);
  CHECK((floor.world.bodies()[0].position_m() - stop.trajectory.at_start().position_m).norm() <
        floor.scenario.tracking_bound_m + stop.inflation_m);
}

TEST_CASE("two noisy frames reveal that a robot was displaced by a centimetre") {
  const std::uint64_t seed = GENERATE(range<std::uint64_t>(1, 11));
  CAPTURE(seed);
  // The robot is at rest. Then the fixes shift by a centimetre without any odometry.
  PoseEstimator still({0, 0}, 0, kBegin, {0.01, 0.005, 0.0015});
  Rng rng(seed);
  Time now = kBegin;
  const auto frame = [&](double x_m) {
    for (int i = 0; i < 17; ++i) still.advance(now += kPhysicsStep, {}, {0, 0}, 0);
    REQUIRE(still.correct(now, {x_m + 0.0015 * rng.normal(), 0.0015 * rng.normal()}, 0));
  };
  for (int i = 0; i < 200; ++i) {
    frame(0);
    REQUIRE(still.jump_m() == 0);
  }
  frame(0.01);
  const double at_first_m = still.jump_m();
  frame(0.01);
  CHECK(std::max(at_first_m, still.jump_m()) > 0.005);
  CHECK((still.position_m() - Vec2(0.01, 0)).norm() < 0.006);
  CHECK(still.position_error_rms_m() > 0.001);
}

TEST_CASE("a slipping robot makes an own stop, and at rest its position is within the reported error") {
  const std::uint64_t seed = GENERATE(range<std::uint64_t>(1, 11));
  CAPTURE(seed);
  Floor floor(seed % 2 == 0 ? noisy(separated_robots(6)) : separated_robots(6), seed);
  floor.run_for(milliseconds(1000));
  for (std::size_t i = 0; i < floor.world.robot_count(); ++i) {
    auto slip = disturbance(static_cast<RobotId>(i), msg::DisturbanceKind::DISTURBANCE_SLIP);
    slip.grip = 0.1;
    slip.duration = milliseconds(300);
    REQUIRE(floor.world.disturb(i, slip, floor.now));
  }
  floor.run_for(milliseconds(400));
  CHECK(floor.own_stops() >= 4);  // the other robots did not accelerate enough to slip
  for (IdealAgent& agent : floor.agents) agent.drives = false;
  floor.run_for(milliseconds(1500));
  for (std::size_t i = 0; i < floor.world.robot_count(); ++i) {
    CAPTURE(i);
    CHECK(floor.world.reference_error_m(i) <
          floor.scenario.tracking_bound_m + floor.world.firmware(i).executing().inflation_m);
    CHECK(floor.world.bodies()[i].velocity_mps().norm() < 0.02);
  }
  CHECK(floor.world.firmware_violations() == 0);
}

TEST_CASE("a robot that learns that it is far from its reference stops where it is") {
  const Scenario scenario = separated_robots(1);
  World world(scenario, kBegin, 1);
  const Vec2 mark = scenario.robots[0].start_m;
  Time now = kBegin;
  const auto send_fix = [&](const Vec2& position_m) {
    now += milliseconds(17);
    world.advance(now);
    Command command = test::bare_command(0, 1);
    command.fix = {now, position_m};
    world.on_command(0, command, now);
  };
  // Wrong fixes suggest that the robot was displaced. It stops at the estimated position, with a large
  // inflation.
  for (int i = 0; i < 10; ++i) send_fix(mark);
  for (int i = 0; i < 3; ++i) send_fix(mark + Vec2(0.15, 0));
  const Version stop = world.firmware(0).executing();
  REQUIRE(stop.inflation_m > 0.1);
  REQUIRE((world.bodies()[0].position_m() - stop.trajectory.rest_position_m()).norm() > 0.1);

  const Vec2 place_m = world.bodies()[0].position_m();
  double max_speed_mps = 0;
  for (int i = 0; i < 60 * 3; ++i) {
    send_fix(world.bodies()[0].position_m());
    max_speed_mps = std::max(max_speed_mps, world.bodies()[0].velocity_mps().norm());
  }
  const Version& last = world.firmware(0).executing();
  CHECK(last.number > stop.number);
  CHECK((last.trajectory.rest_position_m() - place_m).norm() < 0.02);
  CHECK(world.reference_error_m(0) < scenario.tracking_bound_m);
  CHECK((world.bodies()[0].position_m() - place_m).norm() < 0.02);
  CHECK(max_speed_mps < 0.2);
  CHECK(world.firmware_violations() == 0);
}

TEST_CASE("a robot farther from its reference than the bound makes an own stop immediately") {
  // The robot drives 2 m unobserved. Then an observation shows how far it has drifted.
  const double drift_m = 0.001 * GENERATE(range(1, 13)) * (GENERATE(false, true) ? -1 : 1);
  CAPTURE(drift_m);
  Floor floor(separated_robots(1), 1);
  floor.agents[0].drives = false;
  World& world = floor.world;
  const double bound_m = floor.scenario.tracking_bound_m;
  Trajectory dash(floor.now + milliseconds(10), {floor.scenario.robots[0].start_m, {0, 0}});
  dash.append(milliseconds(600), Vec2(3, 0));
  dash.append(milliseconds(800), Vec2(0, 0));
  append_stop(dash, 5);
  world.on_command(0, test::command_with({0, 1, 5, 0, dash}), floor.now);
  for (; floor.now < kBegin + milliseconds(1200); floor.now += kPhysicsStep) world.advance(floor.now);
  Command command = test::bare_command(0, 1);
  command.fix = {world.time(), world.robot_report(0, floor.now).estimate.position_m + Vec2(0, drift_m)};
  REQUIRE(world.firmware(0).own_stops() == 0);
  world.on_command(0, command, floor.now);
  for (const Time end = floor.now + milliseconds(100); floor.now < end;) {
    world.advance(floor.now += kPhysicsStep);
    const RobotReport robot_report = world.robot_report(0, floor.now);
    CHECK(robot_report.tracking_error_m <= bound_m + robot_report.executing.inflation_m);
  }
  // For drifts between the two limits, the uncertainty of the estimate decides.
  if (std::abs(drift_m) < 0.7 * bound_m) CHECK(world.firmware(0).own_stops() == 0);
  if (std::abs(drift_m) > bound_m) CHECK(world.firmware(0).own_stops() == 1);
  CHECK(world.firmware_violations() == 0);
}

TEST_CASE("a robot detects a blocked wheel from its odometry alone") {
  Floor floor(separated_robots(1), 1);
  floor.agents[0].drives = false;
  Trajectory dash(floor.now + milliseconds(10), {floor.scenario.robots[0].start_m, {0, 0}});
  dash.append(milliseconds(500), Vec2(3, 0));
  append_stop(dash, 5);
  floor.world.on_command(0, test::command_with({0, 1, 5, 0, dash}), floor.now);
  floor.run_for(milliseconds(400));
  REQUIRE(floor.world.bodies()[0].velocity_mps().x() > 1);
  auto block = disturbance(0, msg::DisturbanceKind::DISTURBANCE_BLOCK);
  block.heading_rad = 0;
  block.duration = milliseconds(500);
  REQUIRE(floor.world.disturb(0, block, floor.now));
  CHECK(floor.run_until_own_stop(0) <= milliseconds(10));
  floor.run_for(milliseconds(450));
  CHECK(floor.world.bodies()[0].velocity_mps().norm() < 0.02);
  CHECK(floor.world.firmware_violations() == 0);
}

TEST_CASE("a version that continues the robot's own stop brings the robot back on reference") {
  const std::uint64_t seed = GENERATE(range<std::uint64_t>(1, 6));
  CAPTURE(seed);
  Floor floor(separated_robots(1), seed);
  floor.run_for(milliseconds(1000));
  auto push = disturbance(0, msg::DisturbanceKind::DISTURBANCE_PUSH);
  push.push_mps.y() = 1;
  REQUIRE(floor.world.disturb(0, push, floor.now));
  REQUIRE(floor.run_until_own_stop(0) < milliseconds(100));
  floor.run_for(milliseconds(1000));
  CHECK_FALSE(floor.world.firmware(0).is_off_reference());
  CHECK(floor.world.reference_error_m(0) < floor.scenario.tracking_bound_m);
  CHECK(floor.world.firmware_violations() == 0);
}

TEST_CASE("a robot's own stop is numbered above all received versions, pending or refused") {
  Floor floor(separated_robots(1), 1);
  floor.agents[0].drives = false;
  const Vec2 mark = floor.scenario.robots[0].start_m;
  const auto send = [&](VersionNumber number, VersionNumber base, Incarnation incarnation, Duration ahead) {
    const Trajectory rest = Trajectory::resting(floor.now + ahead, mark);
    floor.world.on_command(0, test::command_with({0, incarnation, number, base, rest}), floor.now);
  };
  send(7, 0, 1, milliseconds(2));
  floor.run_for(milliseconds(100));
  send(5'000'000'000, 7, 1, std::chrono::seconds(10));
  send(9'000'000'000, 77, 1, -milliseconds(10));
  REQUIRE(floor.world.firmware(0).executing().number == 7);
  REQUIRE(floor.world.next_start(0) < Time::max());
  REQUIRE(floor.world.disturb(0, disturbance(0, msg::DisturbanceKind::DISTURBANCE_REBOOT), floor.now));
  floor.run_for(milliseconds(5));
  const Version& stop = floor.world.firmware(0).executing();
  CHECK(stop.number > 9'000'000'000);
  CHECK(stop.base == 7);
  CHECK(floor.world.next_start(0) == Time::max());
  CHECK(floor.world.firmware_violations() == 0);
}

}  // namespace sidestep::off_reference_test
