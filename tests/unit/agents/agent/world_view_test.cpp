// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/world_view.hpp"

#include <limits>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::world_view_test {

constexpr RobotId kRobot = 3;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

msg::TrackedRobot tracked_robot(RobotId robot, double x) {
  msg::TrackedRobot tracked;
  tracked.robot(robot);
  tracked.observed_at_ns(1000 + robot);
  tracked.observed_x_m(x);
  tracked.observed_y_m(-x);
  tracked.observed_heading_rad(0.5);
  return tracked;
}

void add_obstacle(msg::WorldState& world, std::uint32_t track, double x) {
  msg::TrackedObstacle& obstacle = world.obstacles()[world.obstacle_count()];
  world.obstacle_count(static_cast<std::uint8_t>(world.obstacle_count() + 1));
  obstacle.obstacle(track);
  obstacle.observed_at_ns(2000 + track);
  obstacle.x_m(x);
  obstacle.y_m(-x);
  obstacle.radius_m(0.1);
  obstacle.position_variance_m2(0.0001);
}

/// The robot among others, and two obstacles.
msg::WorldState valid_world() {
  msg::WorldState world;
  world.header().sender(20000);
  world.header().incarnation(9);
  for (const RobotId robot : {1u, kRobot, 7u}) world.robots().push_back(tracked_robot(robot, 0.25 * robot));
  add_obstacle(world, 5, 1);
  add_obstacle(world, 6, 2);
  return world;
}

TEST_CASE("a world's obstacles and the robot's own observation are decoded unchanged") {
  WorldView view(kRobot);
  const WorldObservations world = view.decode(valid_world());
  CHECK(world.vision == 9);
  REQUIRE(world.self);
  CHECK(world.self->captured_at == time_from_ns(1003));
  CHECK(world.self->position_m == Vec2(0.75, -0.75));
  CHECK(world.self->heading_rad == 0.5);
  REQUIRE(world.obstacle_count == 2);
  CHECK(world.obstacles[0].track == 5);
  CHECK(world.obstacles[0].observed_at == time_from_ns(2005));
  CHECK(world.obstacles[0].position_m == Vec2(1, -1));
  CHECK(world.obstacles[0].radius_m == 0.1);
  CHECK(world.obstacles[0].position_variance_m2 == 0.0001);
  CHECK(world.obstacles[1].track == 6);
  CHECK(view.invalid() == 0);
}

TEST_CASE("the robot is found wherever it is in the world, and only if it is there") {
  const std::uint64_t seed = 1;
  CAPTURE(seed);
  Rng rng(seed);
  WorldView view(kRobot);
  for (int i = 0; i < 2000; ++i) {
    msg::WorldState world;
    world.header().sender(20000);
    for (RobotId robot = 0; robot < 6; ++robot) {
      if (rng.chance(0.7)) world.robots().push_back(tracked_robot(robot, 0.25 * robot));
    }
    rng.shuffle(world.robots());
    const bool is_there =
        std::ranges::any_of(world.robots(), [](const auto& r) { return r.robot() == kRobot; });
    const auto self = view.decode(world).self;
    REQUIRE(self.has_value() == is_there);
    if (self) REQUIRE(self->position_m == Vec2(0.75, -0.75));
  }
  CHECK(view.invalid() == 0);
}

TEST_CASE("an impossible observation of the robot is left out and counted") {
  using Robot = msg::TrackedRobot;
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    for (const auto spoil :
         {+[](Robot&r, double v) { r.observed_x_m(v); }, +[](Robot&r, double v) { r.observed_y_m(v); },
          +[](Robot&r, double v) { r.observed_heading_rad(v); }}) {
      CAPTURE(bad);
      WorldView view(kRobot);
      msg::WorldState world = valid_world();
      spoil(world.robots()[0], bad);  // another robot's is not used
      CHECK(view.decode(world).self);
      CHECK(view.invalid() == 0);
      spoil(world.robots()[1], bad);
      const WorldObservations decoded = view.decode(world);
      CHECK_FALSE(decoded.self);
      CHECK(decoded.obstacle_count == 2);
      CHECK(view.invalid() == 1);
    }
  }
}

TEST_CASE("impossible obstacles are left out and counted, and the rest of the message is still used") {
  using Obstacle = msg::TrackedObstacle;
  const auto check_refused = [](auto spoil) {
    WorldView view(kRobot);
    msg::WorldState message = valid_world();
    spoil(message.obstacles()[0]);
    const WorldObservations world = view.decode(message);
    CHECK(view.invalid() == 1);
    REQUIRE(world.obstacle_count == 1);
    CHECK(world.obstacles[0].track == 6);
    CHECK(world.self);
  };
  for (const double bad : {kNan, kInfinity, -kInfinity, 1e300, -1e300}) {
    CAPTURE(bad);
    check_refused([=](Obstacle& o) { o.x_m(bad); });
    check_refused([=](Obstacle& o) { o.y_m(bad); });
    check_refused([=](Obstacle& o) { o.radius_m(bad); });
    check_refused([=](Obstacle& o) { o.position_variance_m2(bad); });
  }
  check_refused([](Obstacle& o) { o.radius_m(-0.1); });
  check_refused([](Obstacle& o) { o.position_variance_m2(-1); });
}

TEST_CASE("a world with too many obstacles yields none of them, and counts once") {
  const int count = GENERATE(msg::MAX_OBSTACLES + 1, 255);
  CAPTURE(count);
  WorldView view(kRobot);
  msg::WorldState message = valid_world();
  message.obstacle_count(static_cast<std::uint8_t>(count));
  const WorldObservations world = view.decode(message);
  CHECK(world.obstacle_count == 0);
  CHECK(world.self);
  CHECK(view.invalid() == 1);
}

}  // namespace sidestep::world_view_test
