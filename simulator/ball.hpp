// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/geometry/circle.hpp"
#include "common/geometry/field.hpp"
#include "common/motion/trajectory.hpp"
#include "simulator/body.hpp"

namespace sidestep {

struct BallSettings {
  double radius_m = 0.0215;
  double friction_mps2 = 0.3;
  double wall_restitution = 0.6;
  double robot_restitution = 0.2;
};

/// A ball that rolls, bounces off the field's walls and obstacles, and is pushed by robots, which do not
/// notice it.
class Ball {
 public:
  Ball(const State& state, const BallSettings& settings) : state_(state), settings_(settings) {}

  /// Moves on by kPhysicsStep. Robots are discs of robot_radius_m.
  void step(const Field& field, std::span<const Circle> obstacles, std::span<const Body> robots,
            double robot_radius_m);

  const State& state() const { return state_; }

 private:
  void roll();
  void bounce_off_walls(const Field& field);
  void bounce_off_disc(const Vec2& centre_m, double radius_m, const Vec2& velocity_mps, double restitution);

  State state_;
  BallSettings settings_;
};

}  // namespace sidestep
