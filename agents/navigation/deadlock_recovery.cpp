// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/deadlock_recovery.hpp"

#include <algorithm>
#include <numbers>

namespace sidestep {
namespace {

// One decision does not stand for a longer time than this.
constexpr double kLongestStep_s = 0.1;

}  // namespace

void DeadlockRecovery::update(bool is_free, double speed_mps, Time now) {
  const double passed_s = std::clamp(to_seconds(now - last_), 0.0, kLongestStep_s);
  const double step = settings_.rate_radps * passed_s;
  last_ = now;
  if (is_free) {
    free_s_ += passed_s;
    if (!is_needed() || free_s_ > settings_.leaves_s) angle_rad_ -= step;
  } else {
    free_s_ = 0;
    if (speed_mps < settings_.slow_mps) angle_rad_ += step;
  }
  // Once round, it begins anew.
  if (angle_rad_ < 0 || angle_rad_ > 2 * std::numbers::pi) angle_rad_ = 0;
}

}  // namespace sidestep
