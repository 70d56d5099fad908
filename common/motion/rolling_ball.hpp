// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/collision/shapes.hpp"
#include "common/geometry/field.hpp"
#include "common/map/floor_map.hpp"
#include "common/motion/trajectory.hpp"

namespace sidestep {

struct BallSettings {
  double radius_m = 0.0215;
  double friction_mps2 = 0.3;
  double wall_restitution = 0.6;
  double robot_restitution = 0.2;
};

/// The physics of a ball that rolls on the floor and bounces off walls, obstacles and robots.
class RollingBall {
 public:
  RollingBall(const State& state, const BallSettings& settings) : state_(state), settings_(settings) {}

  /// Advances the motion, with friction.
  void roll(double duration_s);
  /// Resolves contact with the walls around the field.
  void bounce_off_walls(const Field& field);
  /// Resolves contact with a static obstacle.
  void bounce_off(const Shape& obstacle) {
    bounce_off(disc_facing(state_.position_m, obstacle), {0, 0}, settings_.wall_restitution);
  }
  /// Resolves contact with the blocked cells of a map.
  void bounce_off(const FloorMap& map) {
    if (const std::optional<Circle> disc = map.disc_facing(state_.position_m, settings_.radius_m))
      bounce_off(*disc, {0, 0}, settings_.wall_restitution);
  }
  /// Resolves contact with a robot, whose motion is not affected.
  void bounce_off_robot(const Circle& robot, const Vec2& velocity_mps) {
    bounce_off(robot, velocity_mps, settings_.robot_restitution);
  }

  const State& state() const { return state_; }

 private:
  void bounce_off(const Circle& disc, const Vec2& velocity_mps, double restitution);

  State state_;
  BallSettings settings_;
};

}  // namespace sidestep
