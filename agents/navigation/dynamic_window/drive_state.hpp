// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/geometry/vec2.hpp"

namespace sidestep {

/// What a differential drive does on its way to a goal.
enum class DriveState {
  kTurn,   ///< turns on the spot until the goal lies ahead
  kGo,     ///< drives to the goal, the faster the better
  kAim,    ///< the goal is no longer ahead: drives on, the slower the better, until it is again
  kAlign,  ///< at the goal: turns to the goal's heading
  kStop    ///< at the goal: rests
};

/// A goal in the robot's frame.
struct DriveGoal {
  Vec2 position_m{0, 0};
  std::optional<double> heading_rad{};  ///< none: any heading
  double radius_m = 0.1;                ///< distance at which the position counts as reached; > 0
};

/// Defaults: Philippsen, EPFL thesis 3146.
struct DriveStateSettings {
  double go_within_rad = 10 * std::numbers::pi / 180;     ///< directions to the goal that count as ahead
  double aim_beyond_rad = 45 * std::numbers::pi / 180;    ///< directions at which the robot has to aim again
  double align_within_rad = 10 * std::numbers::pi / 180;  ///< tolerance of the heading at the goal
  double rest_mps = 0.01;                                 ///< speeds below it count as rest
};

/// Throws std::invalid_argument unless 0 < go_within_rad <= aim_beyond_rad, and the others are positive.
void check(const DriveStateSettings& settings);

/// The state that follows `state`. `speed_mps` is the robot's current speed.
[[nodiscard]] DriveState next_state(DriveState state, const DriveGoal& goal, double speed_mps,
                                    const DriveStateSettings& settings);

}  // namespace sidestep
