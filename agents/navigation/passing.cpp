// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/passing.hpp"

#include <algorithm>

namespace sidestep {
namespace {

// One decision does not stand for a longer time than this.
constexpr double kLongestStep_s = 0.1;

}  // namespace

void PassingOnTheRight::update(bool is_free, double speed_mps, Time now) {
  const double step = settings_.evade_rate_radps * std::clamp(to_seconds(now - last_), 0.0, kLongestStep_s);
  last_ = now;
  if (is_free) {
    evade_rad_ -= step;
  } else if (speed_mps < settings_.slow_mps) {
    evade_rad_ += step;
  }
  evade_rad_ = std::clamp(evade_rad_, 0.0, settings_.evade_most_rad);
}

double PassingOnTheRight::angle_rad(double length_m) const {
  return settings_.angle_rad * std::min(1.0, length_m / settings_.fade_from_m) + evade_rad_;
}

}  // namespace sidestep
