// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "tests/unit/simulator/followed_robot.hpp"
#include "tests/unit/simulator/random_drive.hpp"

namespace sidestep {
namespace {

using std::chrono::milliseconds;
using test::disturbance;
using test::FollowedRobot;
using test::lonely_robots;

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
      for (FollowedRobot& agent : agents) agent.act(now);
    }
  }
  std::uint64_t broke_off(std::size_t robot) const { return world.firmware(robot).counts().broke_off; }
  std::uint64_t broke_off() const {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < world.robot_count(); ++i) sum += broke_off(i);
    return sum;
  }
  // Until the robot breaks off once more than it has by now; beyond a second: never.
  Duration until_broken_off(std::size_t robot) {
    const std::uint64_t before = broke_off(robot);
    const Time since = now;
    while (broke_off(robot) == before && now - since < milliseconds(1000)) run_for(kPhysicsStep);
    return now - since;
  }

  Scenario scenario;
  World world;
  std::vector<FollowedRobot> agents;
  Time now = kBegin;
};

TEST_CASE("a robot that nobody disturbs never breaks off") {
  const std::uint64_t seed = GENERATE(1, 2, 3);
  const bool is_noisy = GENERATE(false, true);
  CAPTURE(seed, is_noisy);
  Floor floor(is_noisy ? noisy(lonely_robots(20)) : lonely_robots(20), seed);
  floor.run_for(std::chrono::seconds(20));
  CHECK(floor.broke_off() == 0);
  CHECK(floor.world.firmware_violations() == 0);
  for (std::size_t i = 0; i < floor.world.robot_count(); ++i) {
    CAPTURE(floor.world.firmware(i).counts().refused_late, floor.world.firmware(i).counts().refused_base,
            floor.world.firmware(i).counts().refused_malformed);
    CHECK(floor.world.firmware(i).counts().taken > 1000);
  }
}

TEST_CASE("a robot that is seen rarely and late gets back to its reference, and does not break off") {
  const std::uint64_t seed = GENERATE(range<std::uint64_t>(1, 11));
  CAPTURE(seed);
  Scenario scenario = lonely_robots(20);
  scenario.vision.delay = milliseconds(120);
  scenario.vision.missed = 0.6;
  Floor floor(scenario, seed);
  floor.run_for(std::chrono::seconds(10));
  CHECK(floor.broke_off() == 0);
}

TEST_CASE("a shoved robot breaks off when the second frame after it has come") {
  const std::uint64_t seed = GENERATE(range<std::uint64_t>(1, 11));
  const bool drives = GENERATE(false, true);
  CAPTURE(seed, drives);
  Floor floor(lonely_robots(1), seed);
  floor.agents[0].drives = drives;
  floor.run_for(milliseconds(2000));
  REQUIRE(floor.broke_off() == 0);
  auto push = disturbance(0, msg::DISTURBANCE_PUSH);
  const Vec2 change = rotated(Vec2(0.3, 0), static_cast<double>(seed));
  push.vx_mps(change.x());
  push.vy_mps(change.y());
  REQUIRE(floor.world.disturb(0, push, floor.now));
  const Duration taken = floor.until_broken_off(0);
  // It slides for 50 ms; a frame every 17 ms, which comes 10 ms later.
  INFO("broke off after " << to_seconds(taken) * 1e3 << " ms");
  CHECK(taken < milliseconds(75));
  const Version stop = floor.world.firmware(0).executing();
  CHECK(floor.world.firmware(0).is_off_reference());
  CHECK(stop.incarnation == 1);
  CHECK(stop.inflation_m > 0);
  CHECK(stop.trajectory.residual_speed_mps() < 1e-9);
  CHECK((floor.world.bodies()[0].position_m() - stop.trajectory.at_start().position_m).norm() <
        floor.scenario.tracking_bound_m + stop.inflation_m);
}

TEST_CASE("two noisy frames tell a robot that was moved past its wheels by a centimetre") {
  const std::uint64_t seed = GENERATE(range<std::uint64_t>(1, 11));
  CAPTURE(seed);
  // The fixes of a world in which the robot stands a centimetre from where its wheels have taken it.
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
  CHECK(still.deviation_m() > 0.001);
}

TEST_CASE("a robot that slips breaks off, and lies within what it announces once it has come to rest") {
  const std::uint64_t seed = GENERATE(range<std::uint64_t>(1, 11));
  CAPTURE(seed);
  Floor floor(seed % 2 == 0 ? noisy(lonely_robots(6)) : lonely_robots(6), seed);
  floor.run_for(milliseconds(1000));
  for (std::size_t i = 0; i < floor.world.robot_count(); ++i) {
    auto slip = disturbance(static_cast<RobotId>(i), msg::DISTURBANCE_SLIP);
    slip.grip(0.1);
    slip.duration_ns(Duration(milliseconds(300)).count());
    REQUIRE(floor.world.disturb(i, slip, floor.now));
  }
  floor.run_for(milliseconds(400));
  CHECK(floor.broke_off() >= 4);  // those that accelerated enough to get away from their references
  for (FollowedRobot& agent : floor.agents) agent.drives = false;
  floor.run_for(milliseconds(1500));
  for (std::size_t i = 0; i < floor.world.robot_count(); ++i) {
    CAPTURE(i);
    CHECK(floor.world.reference_error_m(i) <
          floor.scenario.tracking_bound_m + floor.world.firmware(i).executing().inflation_m);
    CHECK(floor.world.bodies()[i].velocity_mps().norm() < 0.02);
  }
  CHECK(floor.world.firmware_violations() == 0);
}

TEST_CASE("a robot far from what it executes gets back to it without swinging about it") {
  const Scenario scenario = lonely_robots(1);
  World world(scenario, kBegin, 1);
  const Vec2 mark = scenario.robots[0].start_m;
  Time now = kBegin;
  const auto see = [&](const Vec2& position_m) {
    now += milliseconds(17);
    world.advance(now);
    msg::Command command;
    command.head().incarnation(1);
    command.has_fix(true);
    command.fix().captured_at_ns(to_ns(now));
    command.fix().x_m(position_m.x());
    command.fix().y_m(position_m.y());
    world.on_command(0, command, now);
  };
  // Believing that somebody has moved it, it stops where it seems to be, and will not swear to that.
  for (int i = 0; i < 10; ++i) see(mark);
  for (int i = 0; i < 3; ++i) see(mark + Vec2(0.15, 0));
  const Version stop = world.firmware(0).executing();
  REQUIRE(stop.inflation_m > 0.1);
  REQUIRE((world.bodies()[0].position_m() - stop.trajectory.rest_position_m()).norm() > 0.1);

  double fastest_mps = 0, beyond_m = 0;
  for (int i = 0; i < 60 * 3; ++i) {
    see(world.bodies()[0].position_m());
    fastest_mps = std::max(fastest_mps, world.bodies()[0].velocity_mps().norm());
    beyond_m = std::max(beyond_m, world.bodies()[0].position_m().x() - stop.trajectory.rest_position_m().x());
  }
  CHECK(world.firmware(0).executing().number == stop.number);
  CHECK(world.reference_error_m(0) < scenario.tracking_bound_m);
  CHECK(beyond_m < scenario.tracking_bound_m);
  CHECK(fastest_mps < 0.2);
}

TEST_CASE("a robot with a blocked wheel notices by its wheels alone") {
  Floor floor(lonely_robots(1), 1);
  floor.agents[0].drives = false;
  Trajectory dash(floor.now + milliseconds(10), {floor.scenario.robots[0].start_m, {0, 0}});
  dash.append(milliseconds(500), Vec2(3, 0));
  append_stop(dash, 5);
  Version version{0, 1, 5, 0, dash};
  msg::Command command;
  command.head().incarnation(1);
  command.has_version(true);
  command.granted(encode(version));
  floor.world.on_command(0, command, floor.now);
  floor.run_for(milliseconds(400));
  REQUIRE(floor.world.bodies()[0].velocity_mps().x() > 1);
  auto block = disturbance(0, msg::DISTURBANCE_BLOCK);
  block.heading_rad(0);
  block.duration_ns(Duration(milliseconds(500)).count());
  REQUIRE(floor.world.disturb(0, block, floor.now));
  CHECK(floor.until_broken_off(0) <= milliseconds(10));
  floor.run_for(milliseconds(450));
  CHECK(floor.world.bodies()[0].velocity_mps().norm() < 0.02);
  CHECK(floor.world.firmware_violations() == 0);
}

TEST_CASE("a version goes on from the robot's own stop, and it is on its reference again") {
  const std::uint64_t seed = GENERATE(range<std::uint64_t>(1, 6));
  CAPTURE(seed);
  Floor floor(lonely_robots(1), seed);
  floor.run_for(milliseconds(1000));
  auto push = disturbance(0, msg::DISTURBANCE_PUSH);
  push.vy_mps(1);
  REQUIRE(floor.world.disturb(0, push, floor.now));
  REQUIRE(floor.until_broken_off(0) < milliseconds(100));
  floor.run_for(milliseconds(1000));
  CHECK_FALSE(floor.world.firmware(0).is_off_reference());
  CHECK(floor.world.reference_error_m(0) < floor.scenario.tracking_bound_m);
  CHECK(floor.world.firmware_violations() == 0);
}

TEST_CASE("the number of a robot's own stop is above all that it has seen, held or not") {
  Floor floor(lonely_robots(1), 1);
  floor.agents[0].drives = false;
  const Vec2 mark = floor.scenario.robots[0].start_m;
  const auto send = [&](VersionNumber number, VersionNumber base, Incarnation incarnation, Duration ahead) {
    msg::Command command;
    command.head().incarnation(incarnation);
    command.has_version(true);
    command.granted(encode({0, incarnation, number, base, Trajectory::resting(floor.now + ahead, mark)}));
    floor.world.on_command(0, command, floor.now);
  };
  send(7, 0, 1, milliseconds(2));
  floor.run_for(milliseconds(100));
  send(5'000'000'000, 7, 1, std::chrono::seconds(10));
  send(9'000'000'000, 77, 1, -milliseconds(10));
  REQUIRE(floor.world.firmware(0).executing().number == 7);
  REQUIRE(floor.world.next_start(0) < Time::max());
  floor.world.disturb(0, disturbance(0, msg::DISTURBANCE_REBOOT), floor.now);
  floor.run_for(milliseconds(5));
  const Version& stop = floor.world.firmware(0).executing();
  CHECK(stop.number > 9'000'000'000);
  CHECK(stop.base == 7);
  CHECK(floor.world.next_start(0) == Time::max());
  CHECK(floor.world.firmware_violations() == 0);
}

}  // namespace
}  // namespace sidestep
