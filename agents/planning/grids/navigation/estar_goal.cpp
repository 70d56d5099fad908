// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include "agents/planning/grids/navigation/estar.hpp"
#include "agents/planning/grids/navigation/line_of_sight.hpp"

namespace sidestep {

bool EStar::is_euclidean() const {
  return settings_.kernel == GridKernel::kLsm || settings_.kernel == GridKernel::kSecondOrderLsm;
}

void EStar::set_goal(const Vec2& goal_m) {
  const auto cell = layout_.cell_at(goal_m);
  if (!cell) throw std::invalid_argument("the goal lies outside the grid");
  goal_m_ = goal_m;
  goal_ = *cell;
  std::fill(values_.begin(), values_.end(), kBlocked);
  if (unsupported_ > 0) std::fill(raised_from_.begin(), raised_from_.end(), kBlocked);
  unsupported_ = 0;
  queue_.clear();
  changed_.clear();
  const std::uint32_t radius = has_line_of_sight() ? std::max(layout_.columns, layout_.rows)
                                                   : static_cast<std::uint32_t>(settings_.exact_radius_cells);
  const std::uint32_t column = goal_ % layout_.columns, row = goal_ / layout_.columns;
  disc_.first_column = column - std::min(column, radius);
  disc_.first_row = row - std::min(row, radius);
  disc_.last_column = std::min(column + radius, layout_.columns - 1);
  disc_.last_row = std::min(row + radius, layout_.rows - 1);
  exact_begin_ = padded(layout_.cell(0, disc_.first_row));
  exact_.assign(std::size_t{disc_.last_row - disc_.first_row + 1} * stride_, kBlocked);
  compute_exact_values();
}

bool EStar::is_in_disc(GridCell cell) const {
  const std::uint32_t column = cell % layout_.columns, row = cell / layout_.columns;
  return column >= disc_.first_column && column <= disc_.last_column && row >= disc_.first_row &&
         row <= disc_.last_row;
}

/// The exact distance in cells, times the cost; infinite if the cell has no exact value.
float EStar::exact_distance(GridCell cell) const {
  const float goal_cost = cost(goal_);
  if (goal_cost == kBlocked) return kBlocked;
  if (has_line_of_sight()) return line_of_sight_[0].length(cell) * goal_cost;
  if (cell == goal_ && !is_euclidean()) return 0;
  const double distance = (layout_.centre_of(cell) - goal_m_).norm() / layout_.resolution_m;
  if (cell != goal_) {
    if (distance > settings_.exact_radius_cells) return kBlocked;
    const auto is_alike = [&](GridCell other) { return cost(other) == goal_cost; };
    if (!sees(layout_, layout_.in_cells(goal_m_), layout_.in_cells(layout_.centre_of(cell)), is_alike))
      return kBlocked;
  }
  return static_cast<float>(distance) * goal_cost;
}

/// Computes the exact distances. Cells whose cost differs from the goal's cost block lines of sight.
void EStar::compute_sight() {
  const float goal_cost = cost(goal_);
  bool is_uniform_cost = true;
  for (GridCell cell = 0; cell < layout_.size(); ++cell) {
    const float here = cost(cell);
    line_of_sight_[0].set_open(cell, here < kBlocked && here == goal_cost);
    is_uniform_cost = is_uniform_cost && (here == kBlocked || here == goal_cost);
  }
  if (is_uniform_cost != has_uniform_cost_)  // a different equation holds in all cells
    for (GridCell cell = 0; cell < layout_.size(); ++cell) changed_.push_back(padded(cell));
  has_uniform_cost_ = is_uniform_cost;
  line_of_sight_[0].compute(layout_.in_cells(goal_m_));
}

Vec2 EStar::exact_target_m(GridCell cell) const {
  if (!has_line_of_sight() || line_of_sight_[0].source(cell) == LineOfSightDistances::kGoal) return goal_m_;
  return layout_.origin_m + layout_.resolution_m * line_of_sight_[0].position(line_of_sight_[0].source(cell));
}

void EStar::append_exact_path(GridCell cell, std::vector<Vec2>& path_m) const {
  if (has_line_of_sight()) {
    const LineOfSightDistances& line_of_sight = line_of_sight_[0];
    for (auto corner = line_of_sight.source(cell); corner != LineOfSightDistances::kGoal;
         corner = line_of_sight.next(corner))
      path_m.push_back(layout_.origin_m + layout_.resolution_m * line_of_sight.position(corner));
  }
  path_m.push_back(goal_m_);
}

void EStar::compute_exact_values() {
  exact_is_stale_ = false;
  if (has_line_of_sight()) compute_sight();
  for (std::uint32_t row = disc_.first_row; row <= disc_.last_row; ++row) {
    for (std::uint32_t column = disc_.first_column; column <= disc_.last_column; ++column) {
      const GridCell cell = layout_.cell(column, row);
      const float distance = exact_distance(cell);
      float& stored = exact_[padded(cell) - exact_begin_];
      if (distance == stored) continue;
      stored = distance;
      changed_.push_back(padded(cell));
    }
  }
}

}  // namespace sidestep
