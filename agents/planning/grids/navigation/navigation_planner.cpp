// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/navigation/navigation_planner.hpp"

#include <algorithm>
#include <cmath>

#include "agents/planning/grids/navigation/descent.hpp"
#include "agents/planning/grids/navigation/iso_lines.hpp"

namespace sidestep {
namespace {

/// Maximum distance at which a start or goal in a blocked cell is joined to the centre of a free cell;
/// measured from the border of the obstacles if the position touches any.
constexpr double kMaxJoin_m = 0.5;

constexpr std::size_t kFields = 2;

/// Minimum distance that a disc must move to be within the field and touch nothing.
double depth_of(const DiscDomain& domain, const Vec2& position) {
  const double x_m = std::abs(position.x()) + domain.radius_m() - domain.field().length_m / 2;
  const double y_m = std::abs(position.y()) + domain.radius_m() - domain.field().width_m / 2;
  const double in_obstacles_m = domain.radius_m() - domain.world().nearest(position).distance_m;
  return std::max({std::hypot(std::max(x_m, 0.0), std::max(y_m, 0.0)), in_obstacles_m, 0.0});
}

}  // namespace

const Plan<Vec2>& NavigationPlanner::plan(const DiscDomain& domain, const Vec2& start, const Budget& budget,
                                          Rng&) {
  begin_plan(domain, start, plan_);
  if (!settings_.field.keeps_clear() && plan_straight(domain, start, plan_)) return plan_;
  plan_.states.assign(1, start);
  plan_.reason = PlanReason::kUnreachable;
  if (WorldField* field = field_of(domain)) {
    field->update(domain.world());
    plan_.nodes = field->values().layout().size();
    const std::uint64_t expansions = field->values().expansions();
    search(domain, start, budget);
    plan_.samples = field->values().expansions() - expansions;
  }
  plan_.length = length_of(domain, plan_.states);
  return plan_;
}

/// The function for the domain's floor and radius, moved to the front; null if the floor has no cells.
WorldField* NavigationPlanner::field_of(const DiscDomain& domain) {
  const auto known = std::ranges::find_if(
      fields_, [&](const auto& field) { return field->is_for(domain.field(), domain.radius_m()); });
  if (known != fields_.end()) {
    std::rotate(fields_.begin(), known, known + 1);
    return fields_.front().get();
  }
  const auto layout = layout_of(domain.field(), domain.radius_m(), settings_.field);
  if (!layout) return nullptr;
  if (fields_.size() == kFields) fields_.pop_back();
  fields_.insert(fields_.begin(),
                 std::make_unique<WorldField>(*layout, domain.field(), domain.radius_m(), settings_.field));
  return fields_.front().get();
}

std::optional<GridCell> NavigationPlanner::free_cell_at(const Vec2& position) const {
  const EStar& values = fields_.front()->values();
  const auto cell = values.layout().cell_at(position);
  return cell && !values.is_blocked(*cell) ? cell : std::nullopt;
}

/// Finds the position itself if its cell is free, and the centres of free cells nearby, sorted by distance.
/// Motions to them are not checked yet.
void NavigationPlanner::find_joins(const DiscDomain& domain, const Vec2& position,
                                   std::vector<Join>& joins) const {
  joins.clear();
  const EStar& values = fields_.front()->values();
  const GridLayout& layout = values.layout();
  const double reach_m = kMaxJoin_m + depth_of(domain, position);
  const Vec2 at = layout.in_cells(position), reach = Vec2(1, 1) * (reach_m / layout.resolution_m);
  const Vec2 last(layout.columns - 1, layout.rows - 1);
  const Vec2 from = (at - reach).cwiseMax(Vec2(0, 0)), to = (at + reach).cwiseMin(last);
  if (const auto cell = free_cell_at(position)) joins.push_back({position, *cell, 0});
  for (double row = std::floor(from.y()); row <= to.y(); ++row) {
    for (double column = std::floor(from.x()); column <= to.x(); ++column) {
      const GridCell cell = layout.cell(static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row));
      const Vec2 centre = layout.centre_of(cell);
      const double distance_m = domain.distance(position, centre);
      if (distance_m <= reach_m && !values.is_blocked(cell)) joins.push_back({centre, cell, distance_m});
    }
  }
  std::ranges::sort(joins, [](const Join& a, const Join& b) {
    return a.distance_m < b.distance_m || (a.distance_m == b.distance_m && a.cell < b.cell);
  });
}

/// Tries start and goal in their own cells first, which succeeds in most cases.
void NavigationPlanner::search(const DiscDomain& domain, const Vec2& start, const Budget& budget) {
  const Vec2 goal = domain.goal(start);
  const auto start_cell = free_cell_at(start);
  if (start_cell && free_cell_at(goal)) {
    fields_.front()->set_goal(goal);
    if (descend(domain, start, {start, *start_cell, 0}, goal)) return;
  }
  find_joins(domain, goal, goal_joins_);
  std::erase_if(goal_joins_, [&](const Join& join) { return !domain.check(join.at_m, goal); });
  if (goal_joins_.empty()) return;
  find_joins(domain, start, start_joins_);
  std::erase_if(start_joins_, [&](const Join& join) { return !domain.check(start, join.at_m); });
  if (start_joins_.empty()) return;
  while (!goal_joins_.empty()) {
    fields_.front()->set_goal(goal_joins_.front().at_m);
    for (const Join& join : start_joins_)
      if (descend(domain, start, join, goal)) return;
    if (budget.clock && budget.clock() >= budget.until) {
      plan_.reason = PlanReason::kBudgetSpent;
      return;
    }
    forget_reached(goal_joins_);
  }
}

/// Writes the path from the start through the join, if the function leads from there to the goal.
bool NavigationPlanner::descend(const DiscDomain& domain, const Vec2& start, const Join& from,
                                const Vec2& goal) {
  WorldField& field = *fields_.front();
  if (!field.reach(from.cell) || !trace(field.values(), from.at_m, descent_m_)) return false;
  plan_.states.assign(1, start);
  for (const Vec2& at_m : descent_m_)
    if (at_m != plan_.states.back()) plan_.states.push_back(at_m);
  if (goal != plan_.states.back()) plan_.states.push_back(goal);
  const auto is_blocked = [&](const Vec2& a, const Vec2& b) { return !domain.check(a, b); };
  if (std::ranges::adjacent_find(plan_.states, is_blocked) == plan_.states.end()) {
    plan_.reason = PlanReason::kSolved;
    return true;
  }
  plan_.states.resize(1);
  return false;
}

/// Removes the cells from which the function leads to its goal. Since it does not lead there from the start,
/// these cells are not connected with the start either.
void NavigationPlanner::forget_reached(std::vector<Join>& joins) const {
  const EStar& values = fields_.front()->values();
  joins.erase(joins.begin());
  std::erase_if(joins, [&](const Join& join) { return values.value(join.cell) < kBlocked; });
}

std::vector<Segment> NavigationPlanner::directions() const {
  std::vector<Segment> lines;
  if (fields_.empty()) return lines;
  constexpr double kSpacing_m = 0.2;
  const EStar& values = fields_.front()->values();
  const GridLayout& layout = values.layout();
  const auto step = static_cast<std::uint32_t>(std::ceil(kSpacing_m / layout.resolution_m));
  for (std::uint32_t row = step / 2; row < layout.rows; row += step) {
    for (std::uint32_t column = step / 2; column < layout.columns; column += step) {
      const Vec2 from = layout.centre_of(layout.cell(column, row)), along = direction_at(values, from);
      if (!along.isZero(0)) lines.push_back({from, from + 0.7 * step * layout.resolution_m * along});
    }
  }
  return lines;
}

std::vector<Segment> NavigationPlanner::iso_lines() const {
  if (fields_.empty()) return {};
  constexpr double kSpacing_m = 0.25;
  const EStar& values = fields_.front()->values();
  return sidestep::iso_lines(values, kSpacing_m / values.layout().resolution_m);
}

}  // namespace sidestep
