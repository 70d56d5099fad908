// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

#include "common/marking/layout.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// Rings of `symmetries` equally spaced dots around the centre, which give the layout that many rotational
/// symmetries. The layout has no patterns.
inline MarkerLayout random_rings(std::size_t symmetries, std::size_t rings, Rng& rng) {
  MarkerLayout layout;
  layout.centre = {{rng.uniform(-0.02, 0.02), rng.uniform(-0.02, 0.02)}, 0.01};
  for (std::size_t ring = 0; ring < rings; ++ring) {
    const double distance_m = 0.04 + 0.04 * static_cast<double>(ring), first_rad = rng.uniform(0, 6.28);
    for (std::size_t i = 0; i < symmetries; ++i) {
      const double angle_rad =
          first_rad + 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(symmetries);
      layout.dots.push_back({layout.centre.position_m + rotated(Vec2(distance_m, 0), angle_rad), 0.01});
    }
  }
  return layout;
}

}  // namespace sidestep
