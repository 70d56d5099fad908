// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

namespace sidestep {

struct PassingSettings {
  double angle_rad = 0.3;    ///< how far right of the straight way a robot heads that is far from its goal
  double fade_from_m = 3.0;  ///< nearer to the goal than this the angle shrinks in proportion to the distance
  double slow_mps = 0.3;     ///< a robot that is kept from what it wishes and slower than this is blocked
  double evade_rate_radps = 3.0;  ///< how fast it turns farther right while blocked, and back when it is free
  double evade_most_rad = 2.4;
};

/// A common preference to pass on the right: whoever meets evades to the same side, so that swaps do not
/// lock. It is small while the way is free; a robot that is blocked turns farther and farther right, so that
/// a crowd that is jammed begins to turn round its middle and comes apart.
class PassingOnTheRight {
 public:
  explicit PassingOnTheRight(const PassingSettings& settings = {}) : settings_(settings) {}

  /// Once for each decision: whether the robot could do what it wished, how fast it is, and when that is.
  void update(bool is_free, double speed_mps, Time now);
  /// The angle to the right of the way.
  double angle_rad(double length_m) const;

 private:
  PassingSettings settings_;
  double evade_rad_ = 0;
  Time last_{};
};

}  // namespace sidestep
