// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/marking/layout.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// Rings of dots about the centre, each with as many dots as the layout has turns or a multiple of it:
/// `turns` turns put the dots on each other. No patterns.
inline MarkingLayout random_rings(std::size_t turns, std::size_t rings, Rng& rng) {
  MarkingLayout layout;
  layout.centre = {{rng.uniform(-0.02, 0.02), rng.uniform(-0.02, 0.02)}, 0.01};
  for (std::size_t ring = 0; ring < rings; ++ring) {
    const double distance_m = 0.04 + 0.04 * static_cast<double>(ring), first_rad = rng.uniform(0, 6.28);
    for (std::size_t i = 0; i < turns; ++i) {
      const double angle_rad =
          first_rad + 6.283185307179586 * static_cast<double>(i) / static_cast<double>(turns);
      layout.dots.push_back({layout.centre.position_m + rotated(Vec2(distance_m, 0), angle_rad), 0.01});
    }
  }
  return layout;
}

}  // namespace sidestep
