// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/vec2.hpp"

namespace sidestep {

/// What a robot means to do after what it promises: hold a velocity for so long from its version's start on,
/// then make for its goal past a way point. Nobody relies on it; it is for others to plan around.
struct Intent {
  Vec2 velocity_mps{0, 0};
  double hold_s = 0;
  Vec2 waypoint_m{0, 0};
  Vec2 goal_m{0, 0};
};

}  // namespace sidestep
