// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/motion_control.hpp"

#include <algorithm>

#include "common/motion/trapezoid.hpp"

namespace sidestep {

Vec2 wished_acceleration(const State& state, const Vec2& point_m, double length_m, const MotionLimits& limits,
                         const PassingPreference& preference, double horizon_s) {
  Vec2 to_go = point_m - state.position_m;
  const double distance = to_go.norm();
  if (distance > 1e-9) to_go *= length_m / distance;
  const double angle = preference.angle_rad * std::min(1.0, length_m / preference.fade_from_m);
  const Vec2 velocity = trapezoidal_velocity(rotated(to_go, -angle), state.velocity_mps, limits, horizon_s);
  return (velocity - state.velocity_mps) / horizon_s;
}

}  // namespace sidestep
