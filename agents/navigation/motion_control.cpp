// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/motion_control.hpp"

#include <algorithm>

#include "common/motion/trapezoid.hpp"

namespace sidestep {

MotionWish wished_motion(const State& state, const Vec2& point_m, double length_m, const MotionLimits& limits,
                         const PassingPreference& preference, Duration shortest, Duration longest) {
  Vec2 to_go = point_m - state.position_m;
  const double distance = to_go.norm();
  if (distance > 1e-9) to_go *= length_m / distance;
  const double angle = preference.angle_rad * std::min(1.0, length_m / preference.fade_from_m);
  const Trapezoid2d profile(rotated(to_go, -angle), state.velocity_mps, limits);
  const Duration hold = std::clamp(from_seconds(profile.along().first_stretch_s()), shortest, longest);
  const double seconds = to_seconds(hold);
  return {(profile.velocity_after(seconds) - state.velocity_mps) / seconds, hold};
}

}  // namespace sidestep
