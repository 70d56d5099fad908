// SPDX-License-Identifier: Apache-2.0
#include "simulator/ball.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {

void Ball::step(const Field& field, std::span<const Circle> obstacles, std::span<const Body> robots,
                double robot_radius_m) {
  roll();
  for (const Circle& obstacle : obstacles) {
    bounce_off_disc(obstacle.centre_m, obstacle.radius_m, Vec2::Zero(), settings_.wall_restitution);
  }
  for (const Body& robot : robots) {
    if (!robot.is_on_floor()) continue;
    bounce_off_disc(robot.position_m(), robot_radius_m, robot.velocity_mps(), settings_.robot_restitution);
  }
  bounce_off_walls(field);
}

void Ball::roll() {
  const double speed = state_.velocity_mps.norm();
  if (speed <= 0) return;
  const double rolling_s = std::min(kPhysicsStepSeconds, speed / settings_.friction_mps2);
  const Vec2 braking = state_.velocity_mps * (-settings_.friction_mps2 / speed);
  state_ = state_after(state_, braking, rolling_s);
  if (rolling_s < kPhysicsStepSeconds) state_.velocity_mps.setZero();
}

void Ball::bounce_off_walls(const Field& field) {
  const Vec2 most(field.length_m / 2 - settings_.radius_m, field.width_m / 2 - settings_.radius_m);
  for (int axis = 0; axis < 2; ++axis) {
    const double side = state_.position_m[axis] < 0 ? -1 : 1;
    if (side * state_.position_m[axis] <= most[axis]) continue;
    state_.position_m[axis] = side * most[axis];
    if (side * state_.velocity_mps[axis] > 0) state_.velocity_mps[axis] *= -settings_.wall_restitution;
  }
}

void Ball::bounce_off_disc(const Vec2& centre_m, double radius_m, const Vec2& velocity_mps,
                           double restitution) {
  const Vec2 apart = state_.position_m - centre_m;
  const double touching = radius_m + settings_.radius_m;
  const double square = apart.squaredNorm();
  if (square >= touching * touching) return;
  const double distance = std::sqrt(square);
  const Vec2 away = distance > 0 ? Vec2(apart / distance) : Vec2(1, 0);
  state_.position_m = centre_m + away * touching;
  const double approach = (velocity_mps - state_.velocity_mps).dot(away);
  if (approach > 0) state_.velocity_mps += away * (approach * (1 + restitution));
}

}  // namespace sidestep
