// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/evasion.hpp"

#include <algorithm>

namespace sidestep {
namespace {

// One decision does not stand for a longer time than this.
constexpr double kLongestStep_s = 0.1;

}  // namespace

void Evasion::update(bool is_free, double speed_mps, Time now) {
  const double step = settings_.rate_radps * std::clamp(to_seconds(now - last_), 0.0, kLongestStep_s);
  last_ = now;
  if (is_free) {
    angle_rad_ -= step;
  } else if (speed_mps < settings_.slow_mps) {
    angle_rad_ += step;
  }
  angle_rad_ = std::clamp(angle_rad_, 0.0, settings_.most_rad);
}

}  // namespace sidestep
