// SPDX-License-Identifier: Apache-2.0
#include "simulator/world/ball.hpp"

namespace sidestep {

void Ball::step(const Field& field, std::span<const Shape> obstacles, const FloorMap* map,
                std::span<const Body> robots, double robot_radius_m) {
  ball_.roll(kPhysicsStepSeconds);
  for (const Shape& obstacle : obstacles) ball_.bounce_off(obstacle);
  if (map) ball_.bounce_off(*map);
  for (const Body& robot : robots) {
    if (robot.is_on_floor())
      ball_.bounce_off_robot({robot.position_m(), robot_radius_m}, robot.velocity_mps());
  }
  ball_.bounce_off_walls(field);
}

}  // namespace sidestep
