// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/vec2.hpp"

namespace sidestep {

/// What a robot intends beyond its version: hold a velocity from the version's start on, then drive to its
/// goal via a waypoint. Other robots use it for prediction only; safety does not rely on it.
struct Intent {
  Vec2 velocity_mps{0, 0};
  double velocity_duration_s = 0;
  Vec2 waypoint_m{0, 0};
  Vec2 goal_m{0, 0};    ///< the end of its route
  Vec2 target_m{0, 0};  ///< where it wants to be, even if its route ends elsewhere
};

}  // namespace sidestep
