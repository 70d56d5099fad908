// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/geometry/vec2.hpp"

namespace sidestep {

/// The phases of a differential drive's way to a goal.
enum class DriveState {
  kTurn,   ///< turns on the spot until the goal lies ahead
  kGo,     ///< drives to the goal as fast as possible
  kAim,    ///< the goal is no longer ahead: drives on as slowly as possible until it is ahead again
  kAlign,  ///< at the goal: turns to the goal's heading
  kStop    ///< at the goal: rests
};

/// A goal in the robot's frame.
struct DriveGoal {
  Vec2 position_m{0, 0};
  std::optional<double> heading_rad{};  ///< nullopt: any heading
  double radius_m = 0.1;                ///< distance at which the position counts as reached; > 0
};

/// The state that follows `state`. `speed_mps` is the robot's current speed.
[[nodiscard]] DriveState next_state(DriveState state, const DriveGoal& goal, double speed_mps);

}  // namespace sidestep
