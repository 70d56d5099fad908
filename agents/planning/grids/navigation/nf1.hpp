// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/grids/navigation/cost_grid.hpp"

namespace sidestep {

/// The wavefront NF1 (Latombe 1991, section 7.3.1): for every cell the number of steps to the goal between
/// horizontal and vertical neighbours that are not blocked. Ignores costs. Does not allocate once warm.
class Nf1 {
 public:
  static constexpr std::uint32_t kUnreachable = 0xffffffff;

  /// Throws std::invalid_argument if the goal is not a cell of the grid. A blocked goal reaches no cell.
  void propagate(const CostGrid& grid, GridCell goal);
  std::uint32_t steps(GridCell cell) const { return steps_[cell]; }

 private:
  std::vector<std::uint32_t> steps_;
  std::vector<GridCell> wave_;
};

}  // namespace sidestep
