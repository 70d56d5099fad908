// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "agents/planning/grids/winding_segments.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// A random point whose coordinates lie between -half and half.
inline GridPoint random_grid_point(Rng& rng, std::int32_t half) {
  const auto coordinate = [&] {
    return static_cast<std::int32_t>(rng.below(2 * std::uint64_t(half) + 1)) - half;
  };
  const std::int32_t y = coordinate(), x = coordinate();
  return {x, y};
}

/// Up to this many random segments, at most `max_length` long on each axis, split where they cross. On a
/// small grid, many share ends or are vertical.
inline std::vector<GridSegment> random_divided_segments(Rng& rng, std::size_t count, std::int32_t half,
                                                        std::int32_t max_length) {
  std::vector<WindingSegment> winding;
  while (winding.size() < count) {
    const GridPoint a = random_grid_point(rng, half), by = random_grid_point(rng, max_length);
    const GridPoint b{a.x + by.x, a.y + by.y};
    if (std::abs(b.x) > half || std::abs(b.y) > half || a == b) continue;
    winding.push_back({{std::min(a, b), std::max(a, b)}, 1});
  }
  std::vector<GridSegment> segments;
  if (!CrossingDivider().divide(winding)) return segments;
  for (const WindingSegment& part : winding) segments.push_back(part.segment);
  return segments;
}

}  // namespace sidestep
