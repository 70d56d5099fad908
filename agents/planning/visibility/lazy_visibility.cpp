// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/visibility/lazy_visibility.hpp"

#include <algorithm>
#include <numbers>

#include "agents/planning/visibility/tangent_pair.hpp"

namespace sidestep {
namespace {

/// Clearance in addition to the disc's radius: rounding must not cause contact.
constexpr double kLazyStandoff_m = 1e-4;
constexpr double kLazyTurn_rad = 0.35;  ///< maximum turn at a vertex of the path

constexpr std::uint32_t kStart = 0, kGoal = 1, kObstacles = 2;
constexpr std::uint32_t kNone = 0xffffffff;
// A corner's arc covers at most half a circle, or slightly more if the start lies within the standoff.
constexpr double kMaxCornerTurn_rad = 3.2, kMaxCornerTurnSine = -0.0584;

/// Lower bounds of the angles from one direction to two others, tight up to a right angle. Uses the power
/// series of an arc's length in its chord.
SidePair min_turns_rad(const Vec2& from, const DirectionPair& to) {
  const SidePair chord2 = (to.x - from.x()).square() + (to.y - from.y()).square();
  return chord2.sqrt() * (1 + chord2 * (1.0 / 24 + chord2 * (3.0 / 640 + chord2 * (5.0 / 7168))));
}

std::size_t index_of(std::uint32_t arc, Side side) { return 2 * arc + (side == Side::kLeft ? 0 : 1); }

}  // namespace

const Plan<Vec2>& LazyVisibility::plan(const DiscDomain& domain, const Vec2& start, const Budget& budget,
                                       Rng&) {
  begin_plan(domain, start, plan_);
  if (plan_straight(domain, start, plan_)) return plan_;
  if (plan_.start_blocked) {
    plan_from_blocked(domain, start, budget);
  } else {
    plan_from(domain, start, budget);
  }
  plan_.length = length_of(domain, plan_.states);
  return plan_;
}

void LazyVisibility::plan_from(const DiscDomain& domain, const Vec2& start, const Budget& budget) {
  begin_search(domain, start);
  const bool exhausted = search(domain, budget);
  plan_.nodes = arrivals_.size();
  if (plan_.arrives()) return;
  plan_.reason = exhausted ? PlanReason::kUnreachable : PlanReason::kBudgetSpent;
  std::uint32_t nearest = 0;
  const auto to_goal = [&](const Arrival& arrival) {
    const Vec2 at = tangent_point(arcs_[arrival.arc], arrival.side, arrival.along);
    return domain.distance(at, arcs_[kGoal].centre_m);
  };
  for (std::uint32_t i = 1; i < arrivals_.size(); ++i)
    if (to_goal(arrivals_[i]) < to_goal(arrivals_[nearest])) nearest = i;
  write_plan(nearest);
}

void LazyVisibility::plan_from_blocked(const DiscDomain& domain, const Vec2& start, const Budget& budget) {
  const std::optional<Vec2> exit = domain.exit();
  if (!exit) {
    plan_.reason = PlanReason::kUnreachable;
    plan_.states.assign(1, start);
    return;
  }
  if (!plan_straight(domain, *exit, plan_)) plan_from(domain, *exit, budget);
  // The path continues from the last state that the start can reach in a straight line, to skip the exit.
  std::size_t first = plan_.states.size() - 1;
  while (first > 0 && !domain.check(start, plan_.states[first])) --first;
  plan_.states.erase(plan_.states.begin(), plan_.states.begin() + static_cast<std::ptrdiff_t>(first));
  plan_.states.insert(plan_.states.begin(), start);
}

void LazyVisibility::begin_search(const DiscDomain& domain, const Vec2& start) {
  known_.clear(domain.radius_m());
  arrivals_.clear();
  queue_.clear();
  candidates_.clear();
  arcs_.assign({TangentArc{start}, TangentArc{domain.goal(start)}});
  last_.assign(4, kNone);
  is_hidden_.assign(kObstacles, false);
  discover(domain, start, domain.goal(start));
  arrivals_.push_back({kStart, Side::kLeft, {1, 0}, 0, 0, 0, 0, kNone});
  expand(domain, 0, kGoal);
}

/// Returns whether the search ended before the budget was spent.
bool LazyVisibility::search(const DiscDomain& domain, const Budget& budget) {
  while (!queue_.empty()) {
    if (budget.is_spent(arrivals_.size(), plan_.samples++)) return false;
    const OpenEntry entry = pop();
    Arrival next = candidates_[entry.candidate];
    if (next.vertex_turn_rad == 0) {
      // Most of the tangents taken from the queue are blocked, so this check comes first.
      if (!is_tangent_free(domain, next)) continue;
      const double estimate_m = entry.cost_m + refine_cost(next);
      if (!queue_.empty() && estimate_m > queue_.front().cost_m) {
        candidates_[entry.candidate] = next;
        push({estimate_m, entry.candidate});
        continue;
      }
    }
    if (is_dominated(domain, next) || !is_arc_free(domain, next)) continue;
    const auto arrival = static_cast<std::uint32_t>(arrivals_.size());
    std::uint32_t& last = last_[index_of(next.arc, next.side)];
    next.previous = last;
    last = arrival;
    arrivals_.push_back(next);
    if (next.arc == kGoal) {
      plan_.reason = PlanReason::kSolved;
      write_plan(arrival);
      return true;
    }
    expand(domain, arrival, kGoal);
  }
  return true;
}

void LazyVisibility::expand(const DiscDomain& domain, std::uint32_t arrival, std::uint32_t first_arc) {
  const Arrival at = arrivals_[arrival];
  TangentArc from = arcs_[at.arc];
  // A path leaves an arc only beyond the point where it arrived.
  if (from.is_corner)
    (at.side == Side::kLeft ? from.first : from.last) = tangent_point_direction(at.side, at.along);
  promising_.resize(arcs_.size() - first_arc);
  std::size_t count = 0;
  for (std::uint32_t arc = first_arc; arc < arcs_.size(); ++arc) {
    promising_[count] = arc;
    count += arc != at.arc && is_hidden_[arc] == 0 &&
             may_have_tangent(from, at.side, arcs_[arc], 5 * kLazyStandoff_m);
  }
  for (std::size_t i = 0; i < count; ++i) add_candidates(domain, arrival, from, promising_[i]);
}

void LazyVisibility::add_candidates(const DiscDomain& domain, std::uint32_t arrival, const TangentArc& from,
                                    std::uint32_t arc) {
  const Arrival& at = arrivals_[arrival];
  const TangentArc& to = arcs_[arc];
  const TangentPair tangents = tangent_pair(from, at.side, to, kLazyStandoff_m);
  const SidePair from_sides = SidePair::Constant(sign(at.side));
  SidePair slack =
      arc_slack(from, from_sides, tangents.along).min(arc_slack(to, kSideSigns, tangents.along)) + 1e-9;
  // Within the standoff of an edge, a path may leave a start or reach a goal at a small angle to that edge.
  if (at.arc == kStart || arc == kGoal) slack += 2 * kLazyStandoff_m / tangents.length_m;
  const SidePair across = from_sides * cross(at.along, tangents.along), ahead = dot(at.along, tangents.along);
  const SidePair turns_rad = min_turns_rad(at.along, tangents.along);
  const SidePair x_m = to.centre_m.x() + kSideSigns * to.radius_m * tangents.along.y;
  const SidePair y_m = to.centre_m.y() - kSideSigns * to.radius_m * tangents.along.x;
  const Vec2& goal = arcs_[kGoal].centre_m;
  const SidePair to_goal_m = ((x_m - goal.x()).square() + (y_m - goal.y()).square()).sqrt();
  for (Eigen::Index lane = 0; lane < (arc == kGoal ? 1 : 2); ++lane) {
    if (!tangents.exist[lane] || !(slack[lane] >= 0)) continue;
    const bool is_backwards =
        at.arc != kStart && across[lane] < (ahead[lane] > 0 ? -1e-9 : kMaxCornerTurnSine);
    if (from.is_corner && is_backwards) continue;
    const Vec2 point(x_m[lane], y_m[lane]);
    if (!domain.field().contains(point, domain.radius_m())) continue;
    const double turn = is_backwards ? std::numbers::pi : turns_rad[lane];
    const double cost = at.cost_m + from.radius_m * turn + tangents.length_m[lane];
    push({cost + to_goal_m[lane], static_cast<std::uint32_t>(candidates_.size())});
    candidates_.push_back({arc, side_of(lane), tangents.along.at(lane), cost, turn, 0, arrival, kNone});
  }
}

double LazyVisibility::refine_cost(Arrival& next) const {
  next.vertex_turn_rad = kLazyTurn_rad;
  const Arrival& at = arrivals_[next.parent];
  if (at.arc == kStart) return 0;
  const double turn = turn_rad(at.side, at.along, next.along);
  const double extra_m = arcs_[at.arc].radius_m * (turn - next.turn_rad);
  next.turn_rad = turn;
  next.cost_m += extra_m;
  return extra_m;
}

void LazyVisibility::push(const OpenEntry& entry) {
  queue_.push_back(entry);
  std::push_heap(queue_.begin(), queue_.end(), CostsMore());
}

LazyVisibility::OpenEntry LazyVisibility::pop() {
  std::pop_heap(queue_.begin(), queue_.end(), CostsMore());
  const OpenEntry entry = queue_.back();
  queue_.pop_back();
  return entry;
}

bool LazyVisibility::is_dominated(const DiscDomain& domain, const Arrival& next) {
  const TangentArc arc = arcs_[next.arc];
  std::uint32_t i = last_[index_of(next.arc, next.side)];
  for (; i != kNone; i = arrivals_[i].previous) {
    const double turn = turn_rad(next.side, arrivals_[i].along, next.along);
    if (arc.is_corner && turn > kMaxCornerTurn_rad) continue;
    if (next.cost_m < arrivals_[i].cost_m + arc.radius_m * turn - 1e-9) continue;
    if (is_arc_free(domain, arrivals_[i], turn, next.along, kLazyTurn_rad)) return true;
  }
  return false;
}

bool LazyVisibility::is_tangent_free(const DiscDomain& domain, const Arrival& next) {
  const Arrival& at = arrivals_[next.parent];
  const Vec2 from = tangent_point(arcs_[at.arc], at.side, next.along);
  return is_free(domain, from, tangent_point(arcs_[next.arc], next.side, next.along));
}

bool LazyVisibility::is_arc_free(const DiscDomain& domain, Arrival& next) {
  const Arrival& at = arrivals_[next.parent];
  if (is_arc_free(domain, at, next.turn_rad, next.along, next.vertex_turn_rad)) return true;
  // With smaller turns, the polyline stays closer to the arc.
  next.vertex_turn_rad = kLazyTurn_rad / 8;
  return is_arc_free(domain, at, next.turn_rad, next.along, next.vertex_turn_rad);
}

bool LazyVisibility::is_arc_free(const DiscDomain& domain, const Arrival& at, double turn_rad,
                                 const Vec2& along, double vertex_turn_rad) {
  if (arcs_[at.arc].radius_m == 0 || turn_rad == 0) return true;
  vertices_.assign(1, tangent_point(arcs_[at.arc], at.side, at.along));
  append_vertices(arcs_[at.arc], at.side, at.along, turn_rad, vertex_turn_rad, vertices_);
  vertices_.push_back(tangent_point(arcs_[at.arc], at.side, along));
  for (std::size_t i = 1; i < vertices_.size(); ++i)
    if (!is_free(domain, vertices_[i - 1], vertices_[i])) return false;
  return true;
}

bool LazyVisibility::is_free(const DiscDomain& domain, const Vec2& from, const Vec2& to) {
  const Segment motion{from, to};
  if (known_.last_blocks(motion)) return false;
  if (domain.check(from, to)) return true;
  if (!known_.blocks(motion)) discover(domain, from, to);
  return false;
}

void LazyVisibility::discover(const DiscDomain& domain, const Vec2& from, const Vec2& to) {
  if (known_.size() == domain.world().size()) return;
  const std::optional<Contact> contact = domain.world().first_contact(from, to, domain.radius_m());
  if (!contact) return;
  const Shape& shape = domain.world().shape(contact->obstacle);
  const auto first_arc = static_cast<std::uint32_t>(arcs_.size());
  append_arcs(shape, domain.radius_m() + kLazyStandoff_m, arcs_);
  known_.add(shape);
  hide_covered_corners(domain.field(), first_arc);
  last_.resize(arcs_.size() * 2, kNone);
  for (std::uint32_t arrival = 0; arrival < arrivals_.size(); ++arrival) expand(domain, arrival, first_arc);
}

void LazyVisibility::hide_covered_corners(const Field& field, std::size_t first_arc) {
  const std::size_t obstacle = known_.size() - 1;
  for (std::size_t i = first_arc; i < arcs_.size(); ++i) {
    const TangentArc& arc = arcs_[i];
    is_hidden_.push_back(arc.is_corner && (known_.covers(arc.centre_m, 0, obstacle) ||
                                           !field.contains(arc.centre_m, kCoincidence_m)));
  }
  // Only one of several coincident corners is kept.
  const auto is_covered_by_new_corner = [&](const TangentArc& arc) {
    for (std::size_t i = first_arc; i < arcs_.size(); ++i)
      if (is_hidden_[i] != 0 && (arcs_[i].centre_m - arc.centre_m).norm() < 2 * kCoincidence_m) return true;
    return false;
  };
  for (std::size_t i = kObstacles; i < first_arc; ++i)
    if (arcs_[i].is_corner && known_.covers(arcs_[i].centre_m, obstacle, obstacle + 1) &&
        !is_covered_by_new_corner(arcs_[i]))
      is_hidden_[i] = true;
}

void LazyVisibility::write_plan(std::uint32_t arrival) {
  path_.clear();
  for (; arrival != 0; arrival = arrivals_[arrival].parent) path_.push_back(arrival);
  plan_.states.assign(1, arcs_[kStart].centre_m);
  Arrival last = arrivals_[0];
  for (std::size_t i = path_.size(); i-- > 0;) {
    const Arrival& next = arrivals_[path_[i]];
    if (last.arc != kStart) {
      append_vertices(arcs_[last.arc], last.side, last.along, next.turn_rad, next.vertex_turn_rad,
                      plan_.states);
    }
    last = next;
  }
  if (last.arc != kStart || path_.empty())
    plan_.states.push_back(tangent_point(arcs_[last.arc], last.side, last.along));
}

std::vector<Segment> LazyVisibility::explored_tangents() const {
  std::vector<Segment> tangents;
  for (std::size_t i = 1; i < arrivals_.size(); ++i) {
    const Arrival &to = arrivals_[i], &from = arrivals_[to.parent];
    tangents.push_back({tangent_point(arcs_[from.arc], from.side, to.along),
                        tangent_point(arcs_[to.arc], to.side, to.along)});
  }
  return tangents;
}

}  // namespace sidestep
