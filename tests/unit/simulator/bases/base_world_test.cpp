// SPDX-License-Identifier: Apache-2.0
#include "simulator/bases/base_world.hpp"

#include "tests/catch.hpp"

namespace sidestep::base_world_test {
namespace {

using namespace std::chrono_literals;

constexpr Time kBegin = time_from_ns(1'000'000'000'000);

Scenario two_blue() {
  Scenario scenario;
  for (const RobotId id : {0u, 1u}) {
    RobotSpec robot;
    robot.id = id;
    robot.start_m = {-1 + 2.0 * id, 0};
    scenario.robots.push_back(robot);
  }
  scenario.ball = BallSpec{{0, 1}, {0, 0}};
  return scenario;
}

void drive(BaseWorld& world, std::size_t robot, const BaseVelocity& velocity, Duration duration) {
  for (const Time end = world.time() + duration; world.time() < end;) {
    world.command(robot, velocity, world.time());
    world.advance(world.time() + 10ms);
  }
}

}  // namespace

TEST_CASE("teams are completed with opponents that are not in the scenario") {
  BaseWorld world(two_blue(), 6, {}, kBegin);
  CHECK(world.floor().robots.size() == 12);
  REQUIRE(world.find(Team::kBlue, 1) == 1);
  REQUIRE(world.find(Team::kYellow, 5));
  CHECK_FALSE(world.find(Team::kYellow, 6));
  for (const Body& body : world.bodies())
    CHECK(world.floor().field.contains(body.position_m(), world.floor().radius_m));
  msg::GroundTruth truth;
  world.fill(truth);
  CHECK(truth.robots().size() == 2);
  CHECK(truth.robots()[0].reference_error_m() < 0);
}

TEST_CASE(
    "contacts of the scenario's robots are counted, and crashes with opponents are counted separately") {
  BaseWorld world(two_blue(), 2, {}, kBegin);
  const std::size_t opponent = *world.find(Team::kYellow, 0);
  world.place(opponent, {-1, 1}, 0);
  // An opponent drives into a robot at rest.
  drive(world, opponent, {{0, -1}, 0, true}, 1500ms);
  msg::GroundTruth truth;
  world.fill(truth);
  CHECK(truth.contacts() == 0);
  CHECK(truth.crashes() >= 1);
  CHECK(truth.crashes_while_moving() == 0);
  // A robot drives into an opponent at rest.
  world.place(opponent, {1, 1}, 0);
  drive(world, 1, {{0, 1}, 0, true}, 1500ms);
  world.fill(truth);
  CHECK(truth.crashes_while_moving() == 1);
  CHECK(truth.recent_moving_crashes()[0] == 1);
  CHECK(truth.max_robot_crash_speed_mps() > 0.5);
  // Two robots touch.
  world.remove(opponent);
  world.place(0, {-0.5, 0}, 0);
  world.place(1, {0.5, 0}, 0);
  drive(world, 0, {{1, 0}, 0, true}, 1500ms);
  world.fill(truth);
  REQUIRE(truth.contacts() >= 1);
  CHECK(truth.recent_contacts()[0].first() + truth.recent_contacts()[0].second() == 1);
  CHECK(truth.min_clearance_m() < 0.001);
}

TEST_CASE("a robot can kick only a ball that is at its front") {
  BaseWorld world(two_blue(), 0, {}, kBegin);
  CHECK_FALSE(world.kick(0, 4));
  world.set_ball({{-1 + 0.09 + 0.025, 0}, {0, 0}});
  CHECK(world.has_ball(0));
  CHECK_FALSE(world.has_ball(1));
  REQUIRE(world.kick(0, 4));
  world.advance(world.time() + 100ms);
  CHECK(world.ball()->state().velocity_mps.x() > 3.5);
  world.set_ball({{-1 - 0.09 - 0.025, 0}, {0, 0}});
  CHECK_FALSE(world.has_ball(0));
}

}  // namespace sidestep::base_world_test
