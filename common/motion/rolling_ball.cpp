// SPDX-License-Identifier: Apache-2.0
#include "common/motion/rolling_ball.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {

void RollingBall::roll(double duration_s) {
  const double speed = state_.velocity_mps.norm();
  if (speed <= 0) return;
  const double rolling_s = std::min(duration_s, speed / kFriction_mps2);
  const Vec2 braking = state_.velocity_mps * (-kFriction_mps2 / speed);
  state_ = state_after(state_, braking, rolling_s);
  if (rolling_s < duration_s) state_.velocity_mps.setZero();
}

void RollingBall::bounce_off_walls(const Field& field) {
  const Vec2 limit_m(field.length_m / 2 - kRadius_m, field.width_m / 2 - kRadius_m);
  for (int axis = 0; axis < 2; ++axis) {
    const double side = state_.position_m[axis] < 0 ? -1 : 1;
    if (side * state_.position_m[axis] <= limit_m[axis]) continue;
    state_.position_m[axis] = side * limit_m[axis];
    if (side * state_.velocity_mps[axis] > 0) state_.velocity_mps[axis] *= -kWallRestitution;
  }
}

void RollingBall::bounce_off(const Circle& disc, const Vec2& velocity_mps, double restitution) {
  const Vec2 offset = state_.position_m - disc.centre_m;
  const double contact_distance_m = disc.radius_m + kRadius_m;
  const double square = offset.squaredNorm();
  if (square >= contact_distance_m * contact_distance_m) return;
  const double distance = std::sqrt(square);
  const Vec2 normal = distance > 0 ? Vec2(offset / distance) : Vec2(1, 0);
  state_.position_m = disc.centre_m + normal * contact_distance_m;
  const double approach = (velocity_mps - state_.velocity_mps).dot(normal);
  if (approach > 0) state_.velocity_mps += normal * (approach * (1 + restitution));
}

}  // namespace sidestep
