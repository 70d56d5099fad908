// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/navigation/motion_control.hpp"
#include "common/motion/intent.hpp"
#include "common/motion/trajectory.hpp"

namespace sidestep {

/// The shortest and the longest time for which an acceleration may be held.
struct HoldBounds {
  Duration min{};
  Duration max{};
};

/// An intent, and the limits within which a robot follows it.
struct IntentToFollow {
  const Intent& intent;
  State at_start;       ///< the robot's state when the motion starts
  double length_m = 0;  ///< distance that the robot may drive before it stops
  MotionLimits limits{};
  double standstill_mps = 0;  ///< an intended speed below this counts as being at rest
  HoldBounds hold{};
};

/// The acceleration with which a robot follows its intent at up to `max_speed_mps`.
[[nodiscard]] AccelerationCommand follow(const IntentToFollow& followed, double max_speed_mps);

/// The acceleration towards a place at `displacement_m` from the robot.
[[nodiscard]] inline AccelerationCommand hold_towards(const Vec2& displacement_m, const Vec2& velocity_mps,
                                                      const MotionLimits& limits, const HoldBounds& hold) {
  return desired_acceleration(displacement_m, velocity_mps, limits, hold.min, hold.max);
}

}  // namespace sidestep
