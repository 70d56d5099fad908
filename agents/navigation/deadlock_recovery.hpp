// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

namespace sidestep {

struct DeadlockRecoverySettings {
  double slow_mps = 0.3;  ///< a robot that is kept from what it wishes and slower than this is blocked
  double rate_radps = 3;  ///< how fast it turns farther right while blocked, and back when it is free
  double needed_rad = 1;  ///< from here on it goes where it has turned to,
  double leaves_s = 0.5;  ///< and for so long once it is free, to make room for others
};

/// The way out of a jam: a robot that is blocked for long turns farther and farther right, whatever there is
/// to be gained, once round if need be. All do, so a crowd that is jammed begins to turn round its middle and
/// comes apart.
class DeadlockRecovery {
 public:
  explicit DeadlockRecovery(const DeadlockRecoverySettings& settings = {}) : settings_(settings) {}

  /// Once for each decision: whether the robot could do what it wished, how fast it is, and when that is.
  void update(bool is_free, double speed_mps, Time now);
  /// The angle to the right of its way.
  double angle_rad() const { return angle_rad_; }
  bool is_needed() const { return angle_rad_ > settings_.needed_rad; }

 private:
  DeadlockRecoverySettings settings_;
  double angle_rad_ = 0;
  double free_s_ = 0;  // since when it has been
  Time last_{};
};

}  // namespace sidestep
