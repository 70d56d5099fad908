// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

namespace sidestep {

/// Resolves deadlocks: the longer a robot is blocked, the farther right of its route it turns, up to a full
/// circle. Since all robots turn the same way, a jammed group starts to rotate about its centre and
/// dissolves.
class DeadlockRecovery {
 public:
  /// Rate at which the angle grows while blocked and shrinks when free.
  static constexpr double kTurnRate_radps = 3;
  static constexpr double kActivation_rad = 1;  ///< recovery is active while the angle exceeds this
  /// How long an active recovery holds its angle once the robot is free.
  static constexpr double kReleaseDelay_s = 0.5;

  /// Call it once per decision. `is_free`: the robot got its desired motion.
  void update(bool is_free, double speed_mps, Time now);
  /// Angle to turn right of the route, from 0 to 2 pi.
  double angle_rad() const { return angle_rad_; }
  /// Whether the robot should follow the recovery angle instead of its steering.
  bool is_active() const { return angle_rad_ > kActivation_rad; }

 private:
  double angle_rad_ = 0;
  double free_time_s_ = 0;  // uninterrupted time since the robot was last blocked
  Time last_{};
};

}  // namespace sidestep
