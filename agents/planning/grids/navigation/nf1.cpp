// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/navigation/nf1.hpp"

#include <stdexcept>
#include <string>

namespace sidestep {

void Nf1::propagate(const CostGrid& grid, GridCell goal) {
  const GridLayout& layout = grid.layout();
  if (goal >= layout.size()) throw std::invalid_argument("no such cell: " + std::to_string(goal));
  steps_.assign(layout.size(), kUnreachable);
  wave_.clear();
  wave_.reserve(layout.size());
  if (grid.is_blocked(goal)) return;
  const auto reach = [&](GridCell cell, std::uint32_t steps) {
    if (grid.is_blocked(cell) || steps_[cell] != kUnreachable) return;
    steps_[cell] = steps;
    wave_.push_back(cell);
  };
  reach(goal, 0);
  for (std::size_t i = 0; i < wave_.size(); ++i) {
    const GridCell cell = wave_[i];
    const std::uint32_t column = cell % layout.columns, next = steps_[cell] + 1;
    if (column > 0) reach(cell - 1, next);
    if (column + 1 < layout.columns) reach(cell + 1, next);
    if (cell >= layout.columns) reach(cell - layout.columns, next);
    if (cell + layout.columns < layout.size()) reach(cell + layout.columns, next);
  }
}

}  // namespace sidestep
