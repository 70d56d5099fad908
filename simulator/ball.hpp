// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/motion/rolling_ball.hpp"
#include "simulator/body.hpp"

namespace sidestep {

/// A ball that rolls, bounces off the field's walls and obstacles, and is pushed by robots, which do not
/// notice it.
class Ball {
 public:
  Ball(const State& state, const BallSettings& settings) : ball_(state, settings) {}

  /// Moves on by kPhysicsStep. Robots are discs of robot_radius_m.
  void step(const Field& field, std::span<const Circle> obstacles, std::span<const Body> robots,
            double robot_radius_m);

  const State& state() const { return ball_.state(); }

 private:
  RollingBall ball_;
};

}  // namespace sidestep
