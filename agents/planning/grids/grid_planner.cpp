// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/grid_planner.hpp"

#include <algorithm>

namespace sidestep {
namespace {

constexpr double kGridCell_m = 0.1;

constexpr std::uint32_t kNone = 0xffffffff;

}  // namespace

const Plan<Vec2>& GridPlanner::plan(const DiscDomain& domain, const Vec2& start, const Budget& budget, Rng&) {
  begin_plan(domain, start, plan_);
  if (plan_straight(domain, start, plan_)) return plan_;
  lay_out(domain, start);
  search(domain, budget);
  plan_.length = length_of(domain, plan_.states);
  return plan_;
}

/// Places the grid so that the start is the centre of a cell.
void GridPlanner::lay_out(const DiscDomain& domain, const Vec2& start) {
  const double x = domain.field().length_m / 2, y = domain.field().width_m / 2;
  const Vec2 cells_before((start.x() + x) / kGridCell_m, (start.y() + y) / kGridCell_m);
  const Vec2 cells_after((x - start.x()) / kGridCell_m, (y - start.y()) / kGridCell_m);
  const auto floored = [](double count) { return static_cast<Cell>(std::max(std::floor(count), 0.0)); };
  columns_ = floored(cells_before.x()) + floored(cells_after.x()) + 1;
  rows_ = floored(cells_before.y()) + floored(cells_after.y()) + 1;
  start_ = floored(cells_before.y()) * columns_ + floored(cells_before.x());
  origin_m_ = start - kGridCell_m * Vec2(floored(cells_before.x()), floored(cells_before.y()));
  start_m_ = start;
  goal_m_ = domain.goal(start);
  came_from_.assign(std::size_t{columns_} * rows_, kNone);
}

Vec2 GridPlanner::position_of(Cell cell) const {
  if (cell == start_) return start_m_;
  return origin_m_ + kGridCell_m * Vec2(cell % columns_, cell / columns_);
}

void GridPlanner::search(const DiscDomain& domain, const Budget& budget) {
  open_.clear();
  queue_head_ = 0;
  push({0, 0, start_, start_});
  Cell nearest = start_;
  plan_.reason = PlanReason::kUnreachable;
  while (queue_head_ < open_.size()) {
    if (budget.is_spent(plan_.nodes, plan_.samples++)) {
      plan_.reason = PlanReason::kBudgetSpent;
      break;
    }
    const Open at = pop();
    if (came_from_[at.cell] != kNone) continue;
    if (at.cell != start_ && !domain.check(position_of(at.from), position_of(at.cell))) continue;
    came_from_[at.cell] = at.from;
    ++plan_.nodes;
    const double to_goal_m = domain.distance(position_of(at.cell), goal_m_);
    if (to_goal_m < domain.distance(position_of(nearest), goal_m_)) nearest = at.cell;
    if (to_goal_m < 1.5 * kGridCell_m && domain.check(position_of(at.cell), goal_m_)) {
      plan_.reason = PlanReason::kSolved;
      write_plan(at.cell);
      if (to_goal_m > 0) plan_.states.push_back(goal_m_);
      return;
    }
    expand(domain, at);
  }
  write_plan(nearest);
}

void GridPlanner::expand(const DiscDomain& domain, const Open& at) {
  const Cell column = at.cell % columns_, row = at.cell / columns_;
  for (Cell y = row > 0 ? row - 1 : 0; y <= row + 1 && y < rows_; ++y) {
    for (Cell x = column > 0 ? column - 1 : 0; x <= column + 1 && x < columns_; ++x) {
      const Cell next = y * columns_ + x;
      if (came_from_[next] != kNone) continue;
      const bool is_diagonal = x != column && y != row;
      const double cost_m = at.cost_m + kGridCell_m * (is_diagonal ? std::sqrt(2.0) : 1.0);
      push({cost_m + domain.distance(position_of(next), goal_m_), cost_m, next, at.cell});
    }
  }
}

void GridPlanner::push(const Open& open) {
  open_.push_back(open);
  if (settings_.order != GridOrder::kAStar) return;
  std::push_heap(open_.begin(), open_.end(),
                 [](const Open& a, const Open& b) { return a.estimate_m > b.estimate_m; });
}

GridPlanner::Open GridPlanner::pop() {
  if (settings_.order == GridOrder::kBreadthFirst) return open_[queue_head_++];
  if (settings_.order == GridOrder::kAStar) {
    std::pop_heap(open_.begin(), open_.end(),
                  [](const Open& a, const Open& b) { return a.estimate_m > b.estimate_m; });
  }
  const Open open = open_.back();
  open_.pop_back();
  return open;
}

void GridPlanner::write_plan(Cell cell) {
  plan_.states.clear();
  for (; cell != start_; cell = came_from_[cell]) plan_.states.push_back(position_of(cell));
  plan_.states.push_back(position_of(start_));
  std::reverse(plan_.states.begin(), plan_.states.end());
}

std::vector<Segment> GridPlanner::steps() const {
  std::vector<Segment> steps;
  for (Cell cell = 0; cell < came_from_.size(); ++cell)
    if (came_from_[cell] != kNone) steps.push_back({position_of(came_from_[cell]), position_of(cell)});
  return steps;
}

}  // namespace sidestep
