// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/motion_control.hpp"

#include <algorithm>

#include "agents/navigation/trapezoid.hpp"

namespace sidestep {

AccelerationCommand desired_acceleration(const Vec2& to_go_m, const Vec2& velocity_mps, const MotionLimits& limits,
                         Duration shortest, Duration longest) {
  const Trapezoid2d profile(to_go_m, velocity_mps, limits);
  const Duration hold = std::clamp(from_seconds(profile.along().first_stretch_s()), shortest, longest);
  const double seconds = to_seconds(hold);
  return {(profile.velocity_after(seconds) - velocity_mps) / seconds, hold};
}

}  // namespace sidestep
