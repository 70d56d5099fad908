// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/navigation/cost_grid.hpp"

#include <stdexcept>
#include <string>

namespace sidestep {

void check(const GridLayout& layout) {
  constexpr std::uint32_t kMost = 32'000;
  if (layout.size() == 0 || layout.columns > kMost || layout.rows > kMost)
    throw std::invalid_argument("a grid needs 1 to 32,000 columns and rows, not " +
                                std::to_string(layout.columns) + " and " + std::to_string(layout.rows));
  if (!(layout.resolution_m > 0) || !std::isfinite(layout.resolution_m) || !layout.origin_m.allFinite())
    throw std::invalid_argument("a grid needs a positive resolution and a finite origin");
}

void check_cost(float cost) {
  if ((cost >= 1 && cost <= kMaxCost) || cost == kBlocked) return;
  throw std::invalid_argument("a cell's cost must be 1 to 1e6, or infinite, not " + std::to_string(cost));
}

CostGrid::CostGrid(const GridLayout& layout) : layout_(layout) {
  check(layout);
  costs_.assign(layout.size(), 1);
}

void CostGrid::set_cost(GridCell cell, float cost) {
  if (cell >= costs_.size()) throw std::invalid_argument("no such cell: " + std::to_string(cell));
  check_cost(cost);
  costs_[cell] = cost;
}

}  // namespace sidestep
