// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/dynamic_window/drive_state.hpp"

#include <stdexcept>

namespace sidestep {

void check(const DriveStateSettings& settings) {
  if (!(settings.go_within_rad > 0) || !(settings.go_within_rad <= settings.aim_beyond_rad))
    throw std::invalid_argument("the angle to go has to be positive and at most the angle to aim again");
  if (!(settings.align_within_rad > 0) || !(settings.rest_mps > 0))
    throw std::invalid_argument("the tolerances of heading and rest have to be positive");
}

DriveState next_state(DriveState state, const DriveGoal& goal, double speed_mps,
                      const DriveStateSettings& settings) {
  if (goal.position_m.norm() <= goal.radius_m) {
    const double turn_rad = goal.heading_rad ? std::abs(wrapped_rad(*goal.heading_rad)) : 0;
    return turn_rad > settings.align_within_rad ? DriveState::kAlign : DriveState::kStop;
  }
  const double off_rad = std::abs(std::atan2(goal.position_m.y(), goal.position_m.x()));
  if (off_rad <= settings.go_within_rad) return DriveState::kGo;
  switch (state) {
    case DriveState::kGo:
      return off_rad > settings.aim_beyond_rad ? DriveState::kAim : DriveState::kGo;
    case DriveState::kAim:
      return std::abs(speed_mps) < settings.rest_mps ? DriveState::kTurn : DriveState::kAim;
    default:
      return DriveState::kTurn;
  }
}

}  // namespace sidestep
