// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/motion/rolling_ball.hpp"
#include "simulator/world/body.hpp"

namespace sidestep {

/// A ball that rolls and bounces off the field's walls and obstacles. Robots push it without being affected.
class Ball {
 public:
  explicit Ball(const State& state) : ball_(state) {}

  /// Advances by kPhysicsStep. `map` may be null. Robots are discs of robot_radius_m.
  void step(const Field& field, std::span<const Shape> obstacles, const FloorMap* map,
            std::span<const Body> robots, double robot_radius_m);

  const State& state() const { return ball_.state(); }

 private:
  RollingBall ball_;
};

}  // namespace sidestep
