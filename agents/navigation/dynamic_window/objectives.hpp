// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>

namespace sidestep {

/// Weights of the objectives. The defaults are from Philippsen, EPFL thesis 3146.
struct ObjectiveWeights {
  double distance = 0.6, heading = 0.3, speed = 0.1;
};

/// Throws std::invalid_argument unless all weights are finite, none is negative, and their sum is positive.
void check(const ObjectiveWeights& weights);

/// Values of the objectives, each in [0, 1]; 1 is best.
struct Objectives {
  float distance = 0, heading = 0, speed = 0;

  float weighted(const ObjectiveWeights& weights) const {
    return static_cast<float>(weights.distance) * distance + static_cast<float>(weights.heading) * heading +
           static_cast<float>(weights.speed) * speed;
  }
};

/// 0 if the time to collision is just long enough to brake, 1 at the horizon, linear in between.
inline float distance_objective(float time_s, float needed_s, float horizon_s) {
  return (time_s - needed_s) / (horizon_s - needed_s);
}

/// 1 if the direction (x, y) is ahead, 0 if it is behind, linear in the angle from the x axis.
inline float heading_objective(float x, float y) {
  return 1 - std::atan2(std::abs(y), x) * std::numbers::inv_pi_v<float>;
}

}  // namespace sidestep
