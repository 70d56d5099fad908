// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sidestep {

/// The limits that a robot's reference motion obeys.
struct MotionLimits {
  double acceleration_mps2 = 3;  ///< F: maximum acceleration ahead and sideways
  double deceleration_mps2 = 5;  ///< D: deceleration guaranteed when braking against the velocity
  double speed_mps = 2;
};

}  // namespace sidestep
