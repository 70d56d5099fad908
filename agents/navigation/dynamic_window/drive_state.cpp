// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/dynamic_window/drive_state.hpp"

#include <numbers>

namespace sidestep {
namespace {

// The values are from Philippsen, EPFL thesis 3146.
/// Maximum angle of the goal's direction that counts as ahead.
constexpr double kGoWithin_rad = 10 * std::numbers::pi / 180;
/// Angle of the goal's direction beyond which the robot must aim again.
constexpr double kAimBeyond_rad = 45 * std::numbers::pi / 180;
constexpr double kAlignWithin_rad = 10 * std::numbers::pi / 180;  ///< tolerance of the heading at the goal
constexpr double kRest_mps = 0.01;                                ///< slower speeds count as rest

}  // namespace

DriveState next_state(DriveState state, const DriveGoal& goal, double speed_mps) {
  if (goal.position_m.norm() <= goal.radius_m) {
    const double turn_rad = goal.heading_rad ? std::abs(wrapped_rad(*goal.heading_rad)) : 0;
    return turn_rad > kAlignWithin_rad ? DriveState::kAlign : DriveState::kStop;
  }
  const double off_rad = std::abs(std::atan2(goal.position_m.y(), goal.position_m.x()));
  if (off_rad <= kGoWithin_rad) return DriveState::kGo;
  switch (state) {
    case DriveState::kGo:
      return off_rad > kAimBeyond_rad ? DriveState::kAim : DriveState::kGo;
    case DriveState::kAim:
      return std::abs(speed_mps) < kRest_mps ? DriveState::kTurn : DriveState::kAim;
    default:
      return DriveState::kTurn;
  }
}

}  // namespace sidestep
