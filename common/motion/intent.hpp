// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/vec2.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// A robot's intended motion beyond its version: hold a velocity from the version's start on, then drive to
/// its goal via a waypoint. Other robots use it only for prediction; safety does not rely on it.
struct Intent {
  Vec2 velocity_mps{0, 0};
  double velocity_duration_s = 0;
  Vec2 waypoint_m{0, 0};
  /// End of the robot's route. For an idle robot that goes out of the way: the place where it goes, even if
  /// its route ends elsewhere.
  Vec2 goal_m{0, 0};
  Vec2 target_m{0, 0};  ///< the place that the robot wants to reach, even if its route ends elsewhere
  /// When the robot expected to reach its goal when it set out, had it the floor for itself; see
  /// right_of_way.hpp.
  Time due{};
};

}  // namespace sidestep
