// SPDX-License-Identifier: Apache-2.0
#include "tests/catch.hpp"
#include "tests/unit/simulator/world/commands.hpp"
#include "tests/unit/simulator/world/ideal_agent.hpp"
#include "tests/unit/simulator/world/random_drive.hpp"

namespace sidestep::power_test {

using std::chrono::milliseconds;
using test::disturbance;
using test::separated_robots;

const Time kBegin = time_from_ns(1'700'000'000'000'000'000);

TEST_CASE("ground truth reports the time until which a robot without power is carried") {
  World world(separated_robots(1), kBegin, 1);
  Time now = kBegin;
  const auto disturbance_end_ns = [&] {
    msg::GroundTruth truth;
    world.fill(truth);
    return truth.robots().at(0).disturbance_end_ns();
  };
  world.advance(now += milliseconds(100));
  REQUIRE(world.disturb(0, disturbance(0, msg::DisturbanceKind::DISTURBANCE_SWITCH_OFF), now));
  CHECK(disturbance_end_ns() == to_ns(now));
  world.advance(now += milliseconds(500));
  auto carry = disturbance(0, msg::DisturbanceKind::DISTURBANCE_CARRY);
  carry.place_m = {1, 1};
  carry.duration = milliseconds(300);
  REQUIRE(world.disturb(0, carry, now));
  CHECK(disturbance_end_ns() == to_ns(now + milliseconds(300)));
  world.advance(now += milliseconds(400));
  REQUIRE(world.disturb(0, disturbance(0, msg::DisturbanceKind::DISTURBANCE_SWITCH_ON), now));
  CHECK(disturbance_end_ns() == to_ns(now));
}

TEST_CASE("after a power loss, a robot does not execute versions that it received before") {
  World world(separated_robots(1), kBegin, 1);
  Time now = kBegin + milliseconds(30);
  world.advance(now);
  Trajectory dash(now + milliseconds(20), {world.bodies()[0].position_m(), {0, 0}});
  dash.append(milliseconds(100), Vec2(3, 0));
  append_stop(dash, 5);
  world.on_command(0, test::command_with({0, 1, 1, 0, dash}), now);
  REQUIRE(world.disturb(0, disturbance(0, msg::DisturbanceKind::DISTURBANCE_SWITCH_OFF), now));
  world.advance(now += milliseconds(500));
  REQUIRE(world.disturb(0, disturbance(0, msg::DisturbanceKind::DISTURBANCE_SWITCH_ON), now));
  CHECK(world.robot_report(0, now).executing.number == 0);
  world.advance(now += milliseconds(10));
  CHECK(world.robot_report(0, now).is_off_reference);
  CHECK(world.firmware_violations() == 0);
}

}  // namespace sidestep::power_test
