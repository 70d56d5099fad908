// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/grids/navigation/estar.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// A grid with random blocked cells. One third of the grids also have random costs.
inline CostGrid random_grid(Rng& rng, std::uint32_t columns, std::uint32_t rows, double blocked) {
  CostGrid grid({.columns = columns, .rows = rows, .resolution_m = 0.1, .origin_m = {-2, 1}});
  const bool is_weighted = rng.chance(0.33);
  for (GridCell cell = 0; cell < grid.layout().size(); ++cell) {
    if (is_weighted) grid.set_cost(cell, static_cast<float>(rng.uniform(1, 6)));
    if (rng.chance(blocked)) grid.block(cell);
  }
  return grid;
}

inline Vec2 random_position(Rng& rng, const GridLayout& layout) {
  const double x = rng.uniform(0, layout.columns), y = rng.uniform(0, layout.rows);
  return layout.origin_m + layout.resolution_m * Vec2(x, y);
}

inline EStar propagated(const CostGrid& grid, const Vec2& goal_m, const EStarSettings& settings = {}) {
  EStar field(grid, settings);
  field.set_goal(goal_m);
  field.propagate();
  return field;
}

/// The number of cells whose values differ.
inline std::size_t count_differences(const EStar& a, const EStar& b) {
  std::size_t count = 0;
  for (GridCell cell = 0; cell < a.layout().size(); ++cell) count += a.value(cell) != b.value(cell);
  return count;
}

}  // namespace sidestep
