// SPDX-License-Identifier: Apache-2.0
#include "tests/catch.hpp"
#include "tests/unit/simulator/world/commands.hpp"
#include "tests/unit/simulator/world/ideal_agent.hpp"
#include "tests/unit/simulator/world/random_drive.hpp"

namespace sidestep::vision_fault_test {

using std::chrono::milliseconds;
using test::disturbance;
using test::separated_robots;

const Time kBegin = time_from_ns(1'700'000'000'000'000'000);

TEST_CASE("vision faults end after their duration, and ground truth reports faults beyond the error bound") {
  const Scenario scenario = separated_robots(2);
  World world(scenario, kBegin, 1);
  Time now = kBegin + milliseconds(10);
  world.advance(now);
  const auto end_of = [&](std::size_t robot) {
    msg::GroundTruth truth;
    world.fill(truth);
    return truth.robots().at(robot).disturbance_end_ns();
  };
  auto sight = disturbance(0, msg::DisturbanceKind::DISTURBANCE_SEEN_BESIDE);
  sight.duration = milliseconds(100);
  SECTION("a robot is seen beside its true position, within the bound") {
    sight.place_m = Vec2(0, 0.9 * vision_error_bound_m(scenario.tracking_bound_m));
    REQUIRE(world.disturb(0, sight, now));
    CHECK(world.vision_faults()[0].offset_m == sight.place_m);
    CHECK(end_of(0) < 0);
  }
  SECTION("a robot is seen beside its true position, beyond the bound") {
    sight.place_m = Vec2(0, 1.1 * vision_error_bound_m(scenario.tracking_bound_m));
    REQUIRE(world.disturb(0, sight, now));
    CHECK(world.vision_faults()[0].offset_m == sight.place_m);
    CHECK(end_of(0) == to_ns(now + sight.duration));
  }
  SECTION("a robot is seen as another robot") {
    sight.kind = msg::DisturbanceKind::DISTURBANCE_SEEN_AS;
    sight.other_robot = 0;
    CHECK_FALSE(world.disturb(0, sight, now));
    sight.other_robot = 1;
    REQUIRE(world.disturb(0, sight, now));
    CHECK_FALSE(world.disturb(0, sight, now));
    CHECK(world.vision_faults()[0].shown_as == 1);
    CHECK(world.vision_faults()[1].shown_as == 0);
    CHECK(end_of(1) == to_ns(now + sight.duration));
  }
  SECTION("a robot is seen frozen at its former position") {
    sight.kind = msg::DisturbanceKind::DISTURBANCE_SEEN_FROZEN;
    REQUIRE(world.disturb(0, sight, now));
    CHECK(world.vision_faults()[0].frozen->position_m == world.bodies()[0].position_m());
    CHECK(end_of(0) == to_ns(now + sight.duration));
  }
  world.advance(now += milliseconds(110));
  for (const VisionFault& error : world.vision_faults()) {
    CHECK(error.offset_m == Vec2(0, 0));
    CHECK_FALSE(error.shown_as);
    CHECK_FALSE(error.frozen);
  }
}

TEST_CASE("a robot that cameras have misled counts as disturbed until it gets a correct fix") {
  const Scenario scenario = separated_robots(1);
  World world(scenario, kBegin, 1);
  Time now = kBegin + milliseconds(30);
  world.advance(now);
  const Vec2 place_m = world.bodies()[0].position_m();
  const auto end_ns = [&] {
    msg::GroundTruth truth;
    world.fill(truth);
    return truth.robots().at(0).disturbance_end_ns();
  };
  const auto fix = [&](const Vec2& at_m) {
    for (int i = 0; i < 6; ++i) {
      world.advance(now += milliseconds(20));
      Command command = test::command_with({0, 1, 0, 0, Trajectory::resting(now, Vec2(0, 0))});
      command.version.reset();
      command.fix = PoseFix{now - milliseconds(10), at_m, 0};
      world.on_command(0, command, now);
    }
  };
  auto beside = disturbance(0, msg::DisturbanceKind::DISTURBANCE_SEEN_BESIDE);
  beside.place_m = Vec2(0.1, 0);
  beside.duration = milliseconds(150);
  REQUIRE(world.disturb(0, beside, now));
  fix(place_m + beside.place_m);
  world.advance(now += milliseconds(500));
  CHECK(world.vision_faults()[0].offset_m == Vec2(0, 0));
  CHECK(end_ns() >= to_ns(now));
  fix(world.bodies()[0].position_m());
  world.advance(now += milliseconds(100));
  CHECK(end_ns() < to_ns(now));
}

}  // namespace sidestep::vision_fault_test
