// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sidestep {

/// What a robot may ask of itself (safety-protocol: numbers to start from).
struct MotionLimits {
  double acceleration_mps2 = 3;  ///< F, ahead and sideways
  double deceleration_mps2 = 5;  ///< D, guaranteed against the velocity
  double speed_mps = 2;
};

/// A robot as the safety layer sees it: a disc.
struct RobotShape {
  double radius_m = 0.09;
};

}  // namespace sidestep
