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

/// Settings. The defaults are from Philippsen, EPFL thesis 3146.
struct DriveStateSettings {
  /// Maximum angle of the goal's direction that counts as ahead.
  double go_within_rad = 10 * std::numbers::pi / 180;
  /// Angle of the goal's direction beyond which the robot must aim again.
  double aim_beyond_rad = 45 * std::numbers::pi / 180;
  double align_within_rad = 10 * std::numbers::pi / 180;  ///< tolerance of the heading at the goal
  double rest_mps = 0.01;                                 ///< slower speeds count as rest
};

/// Throws std::invalid_argument unless 0 < go_within_rad <= aim_beyond_rad, and the others are positive.
void check(const DriveStateSettings& settings);

/// The state that follows `state`. `speed_mps` is the robot's current speed.
[[nodiscard]] DriveState next_state(DriveState state, const DriveGoal& goal, double speed_mps,
                                    const DriveStateSettings& settings);

}  // namespace sidestep
