// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/cell_graph.hpp"

#include <algorithm>

namespace sidestep {
namespace {

constexpr std::uint32_t kNone = 0xffffffff, kStart = 0xfffffffe, kGoal = 0xfffffffd;

Vec2 nearest_point_in(const ConvexPolygon& cell, const Vec2& position) {
  if (signed_distance(position, std::span<const Vec2>(cell.corners_m)) <= 0) return position;
  Vec2 nearest = cell.corners_m[0];
  for (std::size_t i = 0, last = cell.corners_m.size() - 1; i < cell.corners_m.size(); last = i++) {
    const Vec2 from = cell.corners_m[last], edge = cell.corners_m[i] - from;
    const double length2 = edge.squaredNorm();
    const double fraction = length2 > 0 ? std::clamp((position - from).dot(edge) / length2, 0.0, 1.0) : 0.0;
    const Vec2 on = from + fraction * edge;
    if ((on - position).squaredNorm() < (nearest - position).squaredNorm()) nearest = on;
  }
  return nearest;
}

Vec2 centre_of(const ConvexPolygon& cell) {
  Vec2 sum(0, 0);
  for (const Vec2& corner : cell.corners_m) sum += corner;
  return sum / static_cast<double>(cell.corners_m.size());
}

}  // namespace

void CellSearch::index_portals(const CellGraph& graph) {
  first_portal_.assign(graph.cells.size() + 1, 0);
  for (const Portal& portal : graph.portals) {
    ++first_portal_[portal.a];
    ++first_portal_[portal.b];
  }
  std::uint32_t sum = 0;
  for (std::uint32_t& first : first_portal_) {
    sum += first;
    first = sum;
  }
  portals_by_cell_.resize(sum);
  for (std::uint32_t i = 0; i < graph.portals.size(); ++i) {
    portals_by_cell_[--first_portal_[graph.portals[i].a]] = i;
    portals_by_cell_[--first_portal_[graph.portals[i].b]] = i;
  }
}

/// The cell that contains the position, or else the nearest visible cell. The entry point lies slightly
/// inside the cell: rounding must not exclude the point.
std::optional<CellSearch::Entry> CellSearch::entry(const CellGraph& graph, const DiscDomain& domain,
                                                   const Vec2& position,
                                                   const std::optional<std::uint32_t>& location) const {
  if (location) return Entry{*location, position};
  std::optional<Entry> best;
  double best_m = std::numeric_limits<double>::infinity();
  for (std::uint32_t cell = 0; cell < graph.cells.size(); ++cell) {
    Vec2 at = nearest_point_in(graph.cells[cell], position);
    const double distance_m = domain.distance(at, position);
    if (distance_m >= best_m) continue;
    if (distance_m > 0) at += 0.01 * (centre_of(graph.cells[cell]) - at);
    if (distance_m > 0 && !domain.check(position, at)) continue;
    best = Entry{cell, at};
    best_m = distance_m;
    if (distance_m == 0) break;
  }
  return best;
}

void CellSearch::expand(const CellGraph& graph, std::uint32_t cell, std::uint32_t from, const Vec2& at,
                        double cost_m, const Vec2& goal) {
  for (std::uint32_t i = first_portal_[cell]; i < first_portal_[cell + 1]; ++i) {
    const std::uint32_t portal = portals_by_cell_[i];
    if (came_from_[portal] != kNone) continue;
    const Vec2& middle = graph.portals[portal].middle_m;
    const double next_m = cost_m + (middle - at).norm();
    open_.push_back(
        {next_m + (goal - middle).norm(), next_m, portal, graph.portals[portal].other(cell), from});
    std::push_heap(open_.begin(), open_.end(),
                   [](const Open& a, const Open& b) { return a.estimate_m > b.estimate_m; });
  }
}

/// Returns the last portal before the goal, kStart if start and goal are in the same cell, or nullopt.
std::optional<std::uint32_t> CellSearch::search(const CellGraph& graph, const Entry& from, const Entry& to,
                                                const Budget& budget, Plan<Vec2>& plan) {
  came_from_.assign(graph.portals.size(), kNone);
  leads_into_.resize(graph.portals.size());
  open_.clear();
  if (from.cell == to.cell) return kStart;
  expand(graph, from.cell, kStart, from.at_m, 0, to.at_m);
  while (!open_.empty()) {
    if (budget.is_spent(plan.nodes, plan.samples++)) {
      plan.reason = PlanReason::kBudgetSpent;
      return std::nullopt;
    }
    std::pop_heap(open_.begin(), open_.end(),
                  [](const Open& a, const Open& b) { return a.estimate_m > b.estimate_m; });
    const Open at = open_.back();
    open_.pop_back();
    if (at.portal == kGoal) return at.from;
    if (came_from_[at.portal] != kNone) continue;
    came_from_[at.portal] = at.from;
    leads_into_[at.portal] = at.cell;
    const Vec2& middle = graph.portals[at.portal].middle_m;
    if (at.cell == to.cell) {
      const double length_m = at.cost_m + (to.at_m - middle).norm();
      open_.push_back({length_m, length_m, kGoal, at.cell, at.portal});
      std::push_heap(open_.begin(), open_.end(),
                     [](const Open& a, const Open& b) { return a.estimate_m > b.estimate_m; });
    }
    expand(graph, at.cell, at.portal, middle, at.cost_m, to.at_m);
  }
  return std::nullopt;
}

void CellSearch::plan(const CellGraph& graph, const DiscDomain& domain, const Vec2& start,
                      const Budget& budget, Plan<Vec2>& plan, const CellLocations& locations) {
  plan.states.assign(1, start);
  plan.reason = PlanReason::kUnreachable;
  plan.nodes = graph.cells.size();
  path_.steps.clear();
  index_portals(graph);
  const Vec2 goal = domain.goal(start);
  const std::optional<Entry> from = entry(graph, domain, start, locations.start);
  const std::optional<Entry> to = entry(graph, domain, goal, locations.goal);
  if (!from || !to) return;
  const auto last = search(graph, *from, *to,
                           {budget.nodes + plan.nodes, budget.samples, budget.until, budget.clock}, plan);
  if (!last) return;
  plan.reason = PlanReason::kSolved;
  path_.from_m = from->at_m;
  path_.to_m = to->at_m;
  for (std::uint32_t portal = *last; portal != kStart; portal = came_from_[portal])
    path_.steps.push_back({portal, leads_into_[portal]});
  std::reverse(path_.steps.begin(), path_.steps.end());
  if (from->at_m != start) plan.states.push_back(from->at_m);
  for (const CellPath::Step& step : path_.steps) plan.states.push_back(graph.portals[step.portal].middle_m);
  if (to->at_m != goal) plan.states.push_back(to->at_m);
  plan.states.push_back(goal);
  plan.length = length_of(domain, plan.states);
}

}  // namespace sidestep
