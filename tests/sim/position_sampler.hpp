// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "common/geometry/field.hpp"
#include "common/random/rng.hpp"

namespace sidestep::test {

/// Samples positions on the floor with a minimum distance from each other.
struct PositionSampler {
  Rng& rng;
  const Field& field;
  std::vector<Vec2> taken;

  Vec2 sample_any() {
    const double x = field.length_m / 2 - 0.3, y = field.width_m / 2 - 0.3;
    return {rng.uniform(-x, x), rng.uniform(-y, y)};
  }
  Vec2 sample(double min_distance_m) {
    for (;;) {
      const Vec2 place = sample_any();
      const auto is_near = [&](const Vec2& other) { return (other - place).norm() < min_distance_m; };
      if (std::ranges::any_of(taken, is_near)) continue;
      taken.push_back(place);
      return place;
    }
  }
};

}  // namespace sidestep::test
