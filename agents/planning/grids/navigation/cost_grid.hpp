// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include "agents/planning/grids/navigation/grid_layout.hpp"

namespace sidestep {

/// The cost of a cell that must not be entered.
inline constexpr float kBlocked = std::numeric_limits<float>::infinity();

/// The largest finite cost.
inline constexpr float kMaxCost = 1e6f;

/// Throws std::invalid_argument unless the cost is 1 to kMaxCost, or kBlocked.
void check_cost(float cost);

/// The cost of travelling through each cell of a grid, per metre: 1 on free floor, higher in regions that
/// should be avoided, infinite in obstacles. Throws std::invalid_argument for invalid layouts, costs and
/// cells.
class CostGrid {
 public:
  /// All cells cost 1.
  explicit CostGrid(const GridLayout& layout);

  const GridLayout& layout() const { return layout_; }
  float cost(GridCell cell) const { return costs_[cell]; }
  bool is_blocked(GridCell cell) const { return costs_[cell] == kBlocked; }
  void set_cost(GridCell cell, float cost);
  void block(GridCell cell) { set_cost(cell, kBlocked); }

 private:
  GridLayout layout_;
  std::vector<float> costs_;
};

}  // namespace sidestep
