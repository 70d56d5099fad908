// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/world_state_decoder.hpp"

#include <limits>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::world_state_decoder_test {

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
  tracked.x_m(x + 0.125);
  tracked.y_m(-x);
  return tracked;
}

/// A valid world state with the robot and other robots.
msg::WorldState valid_world() {
  msg::WorldState world;
  world.header().sender(20000);
  world.header().incarnation(9);
  world.valid_at_ns(5000);
  for (const RobotId robot : {1u, kRobot, 7u}) world.robots().push_back(tracked_robot(robot, 0.25 * robot));
  return world;
}

TEST_CASE("a world state's time and the robot's own observation are decoded unchanged") {
  WorldStateDecoder decoder(kRobot);
  const WorldObservations world = decoder.decode(valid_world());
  CHECK(world.vision == 9);
  REQUIRE(world.self);
  CHECK(world.self->captured_at == time_from_ns(1003));
  CHECK(world.self->position_m == Vec2(0.75, -0.75));
  CHECK(world.self->heading_rad == 0.5);
  CHECK(world.valid_at == time_from_ns(5000));
  CHECK(world.self_m == Vec2(0.875, -0.75));
  CHECK_FALSE(world.is_self_seen_elsewhere);
  msg::WorldState doubtful = valid_world();
  doubtful.robots()[1].is_seen_elsewhere(true);
  CHECK(decoder.decode(doubtful).is_self_seen_elsewhere);
  CHECK(decoder.invalid() == 0);
}

TEST_CASE("the robot is found at any index of the world state, and only if it is listed") {
  const std::uint64_t seed = 1;
  CAPTURE(seed);
  Rng rng(seed);
  WorldStateDecoder decoder(kRobot);
  for (int i = 0; i < 2000; ++i) {
    msg::WorldState world;
    world.header().sender(20000);
    for (RobotId robot = 0; robot < 6; ++robot) {
      if (rng.chance(0.7)) world.robots().push_back(tracked_robot(robot, 0.25 * robot));
    }
    rng.shuffle(world.robots());
    const bool is_there =
        std::ranges::any_of(world.robots(), [](const auto& r) { return r.robot() == kRobot; });
    const auto self = decoder.decode(world).self;
    REQUIRE(self.has_value() == is_there);
    if (self) REQUIRE(self->position_m == Vec2(0.75, -0.75));
  }
  CHECK(decoder.invalid() == 0);
}

TEST_CASE("an impossible observation of the robot is omitted and counted") {
  using Robot = msg::TrackedRobot;
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    for (const auto spoil :
         {+[](Robot&r, double v) { r.observed_x_m(v); }, +[](Robot&r, double v) { r.observed_y_m(v); },
          +[](Robot&r, double v) { r.observed_heading_rad(v); }, +[](Robot&r, double v) { r.x_m(v); },
          +[](Robot&r, double v) { r.y_m(v); }}) {
      CAPTURE(bad);
      WorldStateDecoder decoder(kRobot);
      msg::WorldState world = valid_world();
      spoil(world.robots()[0], bad);  // another robot's observation, which is not used
      CHECK(decoder.decode(world).self);
      CHECK(decoder.invalid() == 0);
      spoil(world.robots()[1], bad);
      CHECK_FALSE(decoder.decode(world).self);
      CHECK(decoder.invalid() == 1);
    }
  }
}

}  // namespace sidestep::world_state_decoder_test
