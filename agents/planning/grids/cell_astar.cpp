// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/cell_astar.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>

namespace sidestep {

double CellAstar::estimate(CellHeuristic heuristic, int columns, int rows) {
  const double x = std::abs(columns), y = std::abs(rows);
  switch (heuristic) {
    case CellHeuristic::kNone:
      return 0;
    case CellHeuristic::kStraight:
      return std::hypot(x, y);
    case CellHeuristic::kOctile:
      return std::max(x, y) + (std::numbers::sqrt2 - 1) * std::min(x, y);
    case CellHeuristic::kManhattan:
      return x + y;
  }
  return 0;
}

bool CellAstar::is_free(const BitGrid& blocked, const Cell& cell) const {
  return cell == start_ || cell == goal_ || !blocked.get(cell.column, cell.row);
}

void CellAstar::push(const BitGrid& blocked, const Cell& to, double cost, std::uint32_t from) {
  const std::uint32_t number = number_of(to);
  if (!is_free(blocked, to) || cost >= cost_[number]) return;
  cost_[number] = cost;
  from_[number] = from;
  const double rest = estimate(heuristic_, goal_.column - to.column, goal_.row - to.row);
  open_.push_back({cost + rest, cost, number});
  std::ranges::push_heap(open_, std::greater{}, &Open::estimate);
}

void CellAstar::expand(const BitGrid& blocked, std::uint32_t cell) {
  const Cell at = cell_of(cell);
  const auto has = [&](const Cell& other) {
    return other.column >= 0 && other.row >= 0 && other.column < blocked.columns() &&
           other.row < blocked.rows();
  };
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      const Cell next{at.column + x, at.row + y};
      if ((x == 0 && y == 0) || !has(next)) continue;
      if (x != 0 && y != 0 &&
          !(is_free(blocked, {next.column, at.row}) && is_free(blocked, {at.column, next.row})))
        continue;
      push(blocked, next, cost_[cell] + (x != 0 && y != 0 ? std::numbers::sqrt2 : 1.0), cell);
    }
  }
}

void CellAstar::write_route(std::uint32_t start, std::uint32_t goal) {
  for (std::uint32_t cell = goal; cell != start; cell = from_[cell]) route_.cells.push_back(cell_of(cell));
  route_.cells.push_back(cell_of(start));
  std::ranges::reverse(route_.cells);
  route_.length_cells = cost_[goal];
}

const CellRoute& CellAstar::search(const BitGrid& blocked, const Cell& start, const Cell& goal) {
  columns_ = blocked.columns();
  start_ = start;
  goal_ = goal;
  const auto count = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(blocked.rows());
  cost_.assign(count, std::numeric_limits<double>::infinity());
  from_.assign(count, 0);
  open_.clear();
  route_.cells.clear();
  route_.length_cells = 0;
  route_.expanded = 0;
  push(blocked, start, 0, number_of(start));
  while (!open_.empty()) {
    std::ranges::pop_heap(open_, std::greater{}, &Open::estimate);
    const Open at = open_.back();
    open_.pop_back();
    if (at.cost > cost_[at.cell]) continue;
    if (at.cell == number_of(goal)) {
      write_route(number_of(start), at.cell);
      return route_;
    }
    ++route_.expanded;
    expand(blocked, at.cell);
  }
  return route_;
}

}  // namespace sidestep
