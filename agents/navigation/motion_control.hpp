// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/vec2.hpp"
#include "common/motion/limits.hpp"
#include "common/motion/trajectory.hpp"

namespace sidestep {

/// An acceleration and how long to hold it.
struct AccelerationCommand {
  Vec2 acceleration_mps2{0, 0};
  Duration hold{};
};

/// Returns the first acceleration of the trapezoidal motion (Bruce 2006, appendix B) that comes to rest at
/// `displacement_m` from the current position. It is held for the duration of the profile's first phase,
/// clamped to [min_hold, max_hold]; min_hold > 0. If the motion is shorter than that, no single acceleration
/// achieves it. The result is then the first of two accelerations that are each held for min_hold and
/// together come to rest at the displacement, or, if the robot would have to turn back, an acceleration that
/// first brings it to rest.
[[nodiscard]] AccelerationCommand desired_acceleration(const Vec2& displacement_m, const Vec2& velocity_mps,
                                                       const MotionLimits& limits, Duration min_hold,
                                                       Duration max_hold);

}  // namespace sidestep
