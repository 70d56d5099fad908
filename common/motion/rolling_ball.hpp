// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/collision/shapes.hpp"
#include "common/geometry/field.hpp"
#include "common/map/floor_map.hpp"
#include "common/motion/trajectory.hpp"

namespace sidestep {

/// The physics of a ball that rolls on the floor and bounces off walls, obstacles and robots.
class RollingBall {
 public:
  static constexpr double kRadius_m = 0.0215;
  static constexpr double kFriction_mps2 = 0.3;
  static constexpr double kWallRestitution = 0.6;
  static constexpr double kRobotRestitution = 0.2;

  explicit RollingBall(const State& state) : state_(state) {}

  /// Advances the motion, with friction.
  void roll(double duration_s);
  /// Resolves contact with the walls around the field.
  void bounce_off_walls(const Field& field);
  /// Resolves contact with a static obstacle.
  void bounce_off(const Shape& obstacle) {
    bounce_off(disc_facing(state_.position_m, obstacle), {0, 0}, kWallRestitution);
  }
  /// Resolves contact with the blocked cells of a map.
  void bounce_off(const FloorMap& map) {
    if (const std::optional<Circle> disc = map.disc_facing(state_.position_m, kRadius_m))
      bounce_off(*disc, {0, 0}, kWallRestitution);
  }
  /// Resolves contact with a robot, whose motion is not affected.
  void bounce_off_robot(const Circle& robot, const Vec2& velocity_mps) {
    bounce_off(robot, velocity_mps, kRobotRestitution);
  }

  const State& state() const { return state_; }

 private:
  void bounce_off(const Circle& disc, const Vec2& velocity_mps, double restitution);

  State state_;
};

}  // namespace sidestep
