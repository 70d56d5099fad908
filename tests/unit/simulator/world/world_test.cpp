// SPDX-License-Identifier: Apache-2.0
#include "simulator/world/world.hpp"

#include <vector>

#include "tests/catch.hpp"
#include "tests/unit/simulator/world/commands.hpp"
#include "tests/unit/simulator/world/random_drive.hpp"

namespace sidestep::world_test {

using std::chrono::milliseconds;
using test::RandomDrive;
using test::separated_robots;

const Time kBegin = time_from_ns(1'700'000'000'000'000'000);

// Ground truth after a second of random driving.
msg::GroundTruth truth_after_driving(std::uint64_t seed) {
  Scenario scenario = separated_robots(4);
  scenario.ball = BallSpec{{0, 1}, {1, 0}};
  World world(scenario, kBegin, seed);
  std::vector<RandomDrive> drives;
  for (std::size_t i = 0; i < world.robot_count(); ++i) drives.emplace_back(scenario, world, i, i);
  for (Time t = kBegin; t < kBegin + milliseconds(1000); t += kPhysicsStep) {
    world.advance(t);
    for (RandomDrive& drive : drives) {
      while (drive.due() < t + kPhysicsStep) drive.act(std::max(drive.due(), t));
    }
  }
  msg::GroundTruth truth;
  world.fill(truth);
  return truth;
}

TEST_CASE("the same seed gives the same world, and another seed gives a different one") {
  const auto first = truth_after_driving(1), again = truth_after_driving(1), other = truth_after_driving(2);
  REQUIRE(first.robots().size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(first.robots()[i].x_m() == again.robots()[i].x_m());
    CHECK(first.robots()[i].y_m() == again.robots()[i].y_m());
    CHECK(first.robots()[i].heading_rad() == again.robots()[i].heading_rad());
    CHECK(first.robots()[i].x_m() != other.robots()[i].x_m());
  }
}

TEST_CASE("ground truth contains the state of all objects") {
  const auto truth = truth_after_driving(3);
  CHECK(truth.valid_at_ns() == to_ns(kBegin + milliseconds(999)));
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

TEST_CASE("a collision of robots is reported in ground truth") {
  Scenario scenario = separated_robots(2);
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
  CHECK(world.firmware(0).own_stops() > 0);
  CHECK(truth.firmware_violations() == 0);
}

TEST_CASE("a jump in the executed reference counts as a firmware violation") {
  const Scenario scenario = separated_robots(1);
  World world(scenario, kBegin, 1);
  const Vec2 elsewhere = scenario.robots[0].start_m + Vec2(0.02, 0);
  world.on_command(
      0, test::command_with({0, 1, 1, 0, Trajectory::resting(kBegin + milliseconds(10), elsewhere)}), kBegin);
  world.advance(kBegin + milliseconds(100));
  CHECK(world.firmware_violations() == 1);
}

TEST_CASE("a robot with pending feedback is listed once until its entry is cleared") {
  const Scenario scenario = separated_robots(3);
  World world(scenario, kBegin, 1);
  world.on_command(1, test::bare_command(1, 5), kBegin);
  REQUIRE(world.pending_reports().size() == 1);
  CHECK(world.pending_reports()[0] == 1);
  world.clear_pending_report(1);
  CHECK(world.pending_reports().empty());
  const Vec2 mark = scenario.robots[1].start_m;
  world.on_command(1, test::command_with({1, 5, 1, 0, Trajectory::resting(kBegin + milliseconds(3), mark)}),
                   kBegin);
  world.on_command(1, test::command_with({1, 5, 2, 1, Trajectory::resting(kBegin + milliseconds(5), mark)}),
                   kBegin);
  CHECK(world.pending_reports().empty());
  world.advance(kBegin + milliseconds(10));
  CHECK(world.pending_reports().size() == 1);
  CHECK(world.firmware(1).executing().number == 2);
}

TEST_CASE("robots at rest stay where they are while time is skipped") {
  const Scenario scenario = separated_robots(2);
  World world(scenario, kBegin, 1);
  world.advance(kBegin + milliseconds(100));
  const Time late = kBegin + std::chrono::hours(1);
  world.skip_to(late);
  world.advance(late + milliseconds(200));
  CHECK(world.time() == late + milliseconds(200));
  CHECK(world.reference_error_m(0) < 0.001);
}

}  // namespace sidestep::world_test
