// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/vec2.hpp"
#include "common/motion/limits.hpp"
#include "common/motion/trajectory.hpp"

namespace sidestep {

/// A common small preference to pass on the right: whoever meets evades to the same side, so that swaps do not lock.
struct PassingPreference {
  double angle_rad = 0.5;       ///< how far right of the straight way a robot heads that is far from its goal
  double fade_from_m = 3.0;     ///< nearer to the goal than this the angle shrinks in proportion to the distance
};

/// An acceleration, and for how long to hold it.
struct MotionWish {
  Vec2 acceleration_mps2{0, 0};
  Duration hold{};
};

/// Trapezoidal motion control towards a point, as if the way to go were `length_m` long in that direction (so that a
/// robot does not stop at a way point). The acceleration is held for as long as the profile holds it, but at least
/// for `shortest` and at most for `longest`.
MotionWish wished_motion(const State& state, const Vec2& point_m, double length_m, const MotionLimits& limits,
                         const PassingPreference& preference, Duration shortest, Duration longest);

}  // namespace sidestep
