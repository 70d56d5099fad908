// SPDX-License-Identifier: Apache-2.0
#include "simulator/world.hpp"

#include <catch2/catch.hpp>
#include <vector>

#include "tests/unit/simulator/commands.hpp"
#include "tests/unit/simulator/random_drive.hpp"

namespace sidestep {
namespace {

using std::chrono::milliseconds;
using test::lonely_robots;
using test::RandomDrive;

const Time kBegin = time_from_ns(1'700'000'000'000'000'000);

// What a second of random driving leads to.
msg::GroundTruth truth_after_driving(std::uint64_t seed) {
  Scenario scenario = lonely_robots(4);
  scenario.ball = BallSpec{{0, 1}, {1, 0}};
  World world(scenario, kBegin, seed);
  std::vector<RandomDrive> drives;
  for (std::size_t i = 0; i < world.robot_count(); ++i) drives.emplace_back(scenario, world, i, i);
  for (Time t = kBegin; t < kBegin + milliseconds(1000); t += kPhysicsStep) {
    world.advance(t);
    for (RandomDrive& one : drives) {
      while (one.due() < t + kPhysicsStep) one.act(std::max(one.due(), t));
    }
  }
  msg::GroundTruth truth;
  world.fill(truth);
  return truth;
}

TEST_CASE("the same seed gives the same world, another seed another") {
  const auto first = truth_after_driving(1), again = truth_after_driving(1), other = truth_after_driving(2);
  REQUIRE(first.robots().size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(first.robots()[i].x_m() == again.robots()[i].x_m());
    CHECK(first.robots()[i].y_m() == again.robots()[i].y_m());
    CHECK(first.robots()[i].heading_rad() == again.robots()[i].heading_rad());
    CHECK(first.robots()[i].x_m() != other.robots()[i].x_m());
  }
}

TEST_CASE("the truth says where everything is") {
  const auto truth = truth_after_driving(3);
  CHECK(truth.at_ns() == to_ns(kBegin + milliseconds(999)));
  CHECK(truth.contacts() == 0);
  CHECK(truth.firmware_violations() == 0);
  CHECK(truth.min_clearance_m() == 1);
  CHECK(truth.ball_x_m() == Approx(0.999 - 0.15 * 0.999 * 0.999));
  CHECK(truth.ball_y_m() == Approx(1));
  for (const auto& robot : truth.robots()) {
    CHECK(std::hypot(robot.vx_mps(), robot.vy_mps()) > 0.1);
    CHECK(robot.reference_error_m() < 0.005);
  }
}

TEST_CASE("robots sent into each other are seen to touch, by the truth only") {
  Scenario scenario = lonely_robots(2);
  scenario.robots[0].start_m = Vec2(-0.3, 0);
  scenario.robots[1].start_m = Vec2(0.3, 0);
  World world(scenario, kBegin, 1);
  for (std::size_t i = 0; i < 2; ++i) {
    const double side = i == 0 ? 1 : -1;
    Trajectory trajectory(kBegin + milliseconds(10), {scenario.robots[i].start_m, {0, 0}});
    trajectory.append(milliseconds(400), Vec2(side * 3, 0));
    append_stop(trajectory, 5);
    world.on_command(i, test::command_with({world.id(i), 1, 1, 0, trajectory}), kBegin);
  }
  world.advance(kBegin + milliseconds(2000));
  msg::GroundTruth truth;
  world.fill(truth);
  CHECK(truth.contacts() >= 1);
  CHECK(truth.penetration_m_s() > 0);
  CHECK(truth.min_clearance_m() < 0);
  CHECK(world.firmware(0).counts().broke_off > 0);
  CHECK(truth.firmware_violations() == 0);
}

TEST_CASE("a jump in what a robot is told to execute is blamed on the firmware that took it") {
  const Scenario scenario = lonely_robots(1);
  World world(scenario, kBegin, 1);
  const Vec2 elsewhere = scenario.robots[0].start_m + Vec2(0.02, 0);
  world.on_command(
      0, test::command_with({0, 1, 1, 0, Trajectory::resting(kBegin + milliseconds(10), elsewhere)}), kBegin);
  world.advance(kBegin + milliseconds(100));
  CHECK(world.firmware_violations() == 1);
}

TEST_CASE("robots with news are named once, until it is taken note of") {
  const Scenario scenario = lonely_robots(3);
  World world(scenario, kBegin, 1);
  world.on_command(1, test::bare_command(1, 5), kBegin);
  REQUIRE(world.news().size() == 1);
  CHECK(world.news()[0] == 1);
  world.clear_news(1);
  CHECK(world.news().empty());
  const Vec2 mark = scenario.robots[1].start_m;
  world.on_command(1, test::command_with({1, 5, 1, 0, Trajectory::resting(kBegin + milliseconds(3), mark)}),
                   kBegin);
  world.on_command(1, test::command_with({1, 5, 2, 1, Trajectory::resting(kBegin + milliseconds(5), mark)}),
                   kBegin);
  CHECK(world.news().empty());
  world.advance(kBegin + milliseconds(10));
  CHECK(world.news().size() == 1);
  CHECK(world.firmware(1).executing().number == 2);
}

TEST_CASE("time that is passed over leaves robots at rest where they were") {
  const Scenario scenario = lonely_robots(2);
  World world(scenario, kBegin, 1);
  world.advance(kBegin + milliseconds(100));
  const Time late = kBegin + std::chrono::hours(1);
  world.skip_to(late);
  world.advance(late + milliseconds(200));
  CHECK(world.time() == late + milliseconds(200));
  CHECK(world.reference_error_m(0) < 0.001);
}

}  // namespace
}  // namespace sidestep
