// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/deadlock_recovery.hpp"

#include <algorithm>
#include <numbers>

namespace sidestep {
namespace {

/// A robot that was denied its desired motion is blocked below this speed.
constexpr double kBlockedSpeed_mps = 0.3;

// Upper bound of the time by which a single decision changes the angle.
constexpr double kMaxStep_s = 0.1;

}  // namespace

void DeadlockRecovery::update(bool is_free, double speed_mps, Time now) {
  const double elapsed_s = std::clamp(to_seconds(now - last_), 0.0, kMaxStep_s);
  const double step = kTurnRate_radps * elapsed_s;
  last_ = now;
  if (is_free) {
    free_time_s_ += elapsed_s;
    if (!is_active() || free_time_s_ > kReleaseDelay_s) angle_rad_ -= step;
  } else {
    free_time_s_ = 0;
    if (speed_mps < kBlockedSpeed_mps) angle_rad_ += step;
  }
  // After a full circle the angle starts again from 0.
  if (angle_rad_ < 0 || angle_rad_ > 2 * std::numbers::pi) angle_rad_ = 0;
}

}  // namespace sidestep
