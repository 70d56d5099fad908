// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/dynamic_window/objectives.hpp"

#include <stdexcept>

namespace sidestep {

void check(const ObjectiveWeights& weights) {
  const double sum = weights.distance + weights.heading + weights.speed;
  if (!(weights.distance >= 0) || !(weights.heading >= 0) || !(weights.speed >= 0) || !(sum > 0) ||
      !std::isfinite(sum))
    throw std::invalid_argument("objective weights have to be finite, not negative, and not all zero");
}

}  // namespace sidestep
