// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/vec2.hpp"
#include "common/motion/limits.hpp"
#include "common/motion/trajectory.hpp"

namespace sidestep {

/// An acceleration, and for how long to hold it.
struct AccelerationCommand {
  Vec2 acceleration_mps2{0, 0};
  Duration hold{};
};

/// Trapezoidal motion control (Bruce, app. B) from a state to rest at the offset `to_go_m`. The acceleration
/// is held for as long as the profile holds it, but at least for `shortest` and at most for `longest`.
AccelerationCommand desired_acceleration(const Vec2& to_go_m, const Vec2& velocity_mps, const MotionLimits& limits,
                         Duration shortest, Duration longest);

}  // namespace sidestep
