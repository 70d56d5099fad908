// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/motion_control.hpp"

#include <algorithm>

#include "agents/navigation/trapezoidal_profile.hpp"

namespace sidestep {

AccelerationCommand desired_acceleration(const Vec2& displacement_m, const Vec2& velocity_mps,
                                         const MotionLimits& limits, Duration min_hold, Duration max_hold) {
  const TrapezoidalProfile2d profile(displacement_m, velocity_mps, limits);
  const Duration hold = std::clamp(from_seconds(profile.along().first_phase_s()), min_hold, max_hold);
  const double seconds = to_seconds(hold);
  if (profile.along().duration_s() > seconds)
    return {(profile.velocity_after(seconds) - velocity_mps) / seconds, hold};
  // The velocity between the two accelerations that bring the robot to rest at the displacement.
  Vec2 between_mps = displacement_m / seconds - 0.5 * velocity_mps;
  // A robot that would have to turn back first comes to rest: the limit on accelerating after the turn would
  // also weaken the braking before it.
  const double along = between_mps.dot(velocity_mps);
  if (along < 0) between_mps -= along / velocity_mps.squaredNorm() * velocity_mps;
  return {(between_mps - velocity_mps) / seconds, hold};
}

}  // namespace sidestep
