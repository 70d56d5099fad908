// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

namespace sidestep {

struct DeadlockRecoverySettings {
  double blocked_speed_mps = 0.3;  ///< a robot that was denied its desired motion is blocked below this speed
  double turn_rate_radps = 3;      ///< rate at which the angle grows while blocked and shrinks when free
  double activation_rad = 1;       ///< recovery is active while the angle exceeds this
  double release_delay_s = 0.5;    ///< how long an active recovery holds its angle once the robot is free
};

/// Resolves deadlocks: the longer a robot is blocked, the farther right of its route it turns, up to a full
/// circle. Since all robots turn the same way, a jammed group starts to rotate about its centre and
/// dissolves.
class DeadlockRecovery {
 public:
  explicit DeadlockRecovery(const DeadlockRecoverySettings& settings = {}) : settings_(settings) {}

  /// Call once per decision, with the time since the last one. `is_free`: the robot got its desired motion.
  void update(bool is_free, double speed_mps, Time now);
  /// Angle to turn right of the route, from 0 to 2 pi.
  double angle_rad() const { return angle_rad_; }
  /// Whether the robot should follow the recovery angle instead of its steering.
  bool is_active() const { return angle_rad_ > settings_.activation_rad; }

 private:
  DeadlockRecoverySettings settings_;
  double angle_rad_ = 0;
  double free_time_s_ = 0;  // uninterrupted time since the robot was last blocked
  Time last_{};
};

}  // namespace sidestep
