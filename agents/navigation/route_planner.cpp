// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/route_planner.hpp"

#include <algorithm>
#include <limits>

#include "agents/planning/domain/nearest_reachable.hpp"

namespace sidestep {
namespace {

// A route is replanned if its remaining length exceeds the smallest value so far by more than this.
constexpr double kReplanIncrease_m = 0.05;
// A waypoint that the robot must pass is reached at this distance.
constexpr double kReached_m = 0.1;
// Maximum deviation when a path that keeps clear of obstacles is straightened.
constexpr double kMaxStraightening_m = 0.02;
// Random samples cost more than expanded states, and a planner uses all its samples if there is no path.
constexpr std::size_t kMaxRandomSamples = 1500;
// Maximum number of nodes of roadmaps, which would otherwise grow with each query that they do not solve.
constexpr std::size_t kMaxRandomNodes = 2000;
// Nearby changes do not affect the part of the last route that is farther away than this.
constexpr double kFar_m = 20;

}  // namespace

RoutePlanner::RoutePlanner(const NamedPlanner& planner, const ObstacleWorld& obstacles, const Field& field,
                           double radius_m, double margin_m, std::span<const double> extra_clearances_m)
    : world_(&obstacles),
      field_(field),
      radius_m_(radius_m),
      required_m_(radius_m + margin_m),
      clearance_m_(required_m_),
      planner_(&planner),
      domain_settings_(planner.domain_settings(field, radius_m)) {
  for (const double extra_m : extra_clearances_m) preferred_m_.push_back(required_m_ + extra_m);
  if (!planner.is_shortest) exact_.emplace(make_driving_planner("lazy-visibility"));
}

Budget RoutePlanner::budget(const NamedPlanner& planner) const {
  Budget budget;
  budget.samples = planner.is_random ? kMaxRandomSamples : samples_;
  if (planner.is_random) budget.nodes = kMaxRandomNodes;
  return budget;
}

void RoutePlanner::begin(const Vec2& goal_m) {
  if (goal_m == goal_m_) {
    remember_route();
  } else {
    samples_ = kCycleSamples;
    last_route_.clear();
  }
  goal_m_ = goal_m;
  clearance_m_ = preferred_m_.back();
  has_tight_end_ = false;
  waypoints_.clear();
  next_waypoint_ = 0;
}

void RoutePlanner::remember_route() {
  if (waypoints_.empty() || waypoints_.back() != goal_m_) return;
  const auto remaining = remaining_waypoints_m();
  last_route_.assign(remaining.begin(), remaining.end());
  has_last_tight_end_ = has_tight_end_;
}

/// The clearance applies only to obstacles; at the edge of the field it is the robot's radius.
Field RoutePlanner::extended_field() const {
  const double extra = 2 * (clearance_m_ - radius_m_);
  return {field_.length_m + extra, field_.width_m + extra};
}

DiscDomain RoutePlanner::domain(const Vec2& start, const Vec2& goal) const {
  return {*world_, extended_field(), clearance_m_, start, goal, domain_settings_};
}

bool RoutePlanner::is_line_free(const Vec2& from, const Vec2& to) const {
  using WithoutGoal = DiscDomain::WithoutGoal;
  return DiscDomain(WithoutGoal(), *world_, extended_field(), clearance_m_, from, domain_settings_)
      .check(from, to);
}

bool RoutePlanner::is_leg_free(const Vec2& from, std::size_t waypoint) const {
  if (!has_tight_end_ || waypoint + 1 < waypoints_.size()) return is_line_free(from, waypoints_[waypoint]);
  return !world_->touches(from, waypoints_[waypoint], required_m_);
}

bool RoutePlanner::is_free_from(const Vec2& start) const {
  if (next_waypoint_ >= waypoints_.size() || !is_leg_free(start, next_waypoint_)) return false;
  for (std::size_t i = next_waypoint_ + 1; i < waypoints_.size(); ++i)
    if (!is_leg_free(waypoints_[i - 1], i)) return false;
  return true;
}

std::optional<ObstacleId> RoutePlanner::obstacle_on_goal() const {
  const Nearest nearest = world_->nearest(goal_m_);
  if (nearest.distance_m > required_m_) return std::nullopt;
  return nearest.obstacle;
}

bool RoutePlanner::follow(const NamedPlanner& planner, const DiscDomain& domain, const Plan<Vec2>& plan) {
  next_waypoint_ = 0;
  waypoints_.clear();
  has_tight_end_ = false;
  if (!plan.arrives()) return false;
  const auto take = [this](const Plan<Vec2>& path) {
    waypoints_.assign(path.states.begin() + 1, path.states.end());
  };
  if (planner.is_shortest) {
    take(plan);
  } else if (planner.keeps_clear) {
    store_straightened(plan.states);
  } else {
    Plan<Vec2> smoothed = plan;
    LeaderFollower<DiscDomain>().smooth(domain, smoothed);
    take(smoothed);
  }
  return !waypoints_.empty();
}

void RoutePlanner::store_straightened(std::span<const Vec2> path) {
  waypoints_.clear();
  for (std::size_t from = 0; from + 1 < path.size();) {
    std::size_t to = from + 1;
    const auto is_straight = [&](std::size_t end) {
      const Segment line{path[from], path[end]};
      const auto is_near = [&](const Vec2& p) {
        return squared_distance(p, line) < kMaxStraightening_m * kMaxStraightening_m;
      };
      return std::ranges::all_of(path.subspan(from + 1, end - from - 1), is_near) &&
             is_line_free(path[from], path[end]);
    };
    while (to + 1 < path.size() && is_straight(to + 1)) ++to;
    waypoints_.push_back(path[to]);
    from = to;
  }
}

bool RoutePlanner::replan(const NamedPlanner& planner, const Vec2& start, double clearance, Rng& rng) {
  clearance_m_ = clearance;
  const DiscDomain here = domain(start, goal_m_);
  const Plan<Vec2>& plan = planner.plan(here, start, budget(planner), rng);
  is_cut_short_ |= plan.reason == PlanReason::kBudgetSpent && !planner.is_random;
  return follow(planner, here, plan);
}

bool RoutePlanner::replan_to_tight_goal(const NamedPlanner& planner, const Vec2& start, double clearance,
                                        Rng& rng) {
  if (!replan(planner, start, clearance, rng)) return false;
  if (waypoints_.back() == goal_m_) return true;
  if (world_->touches(waypoints_.back(), goal_m_, required_m_)) return false;
  waypoints_.push_back(goal_m_);
  has_tight_end_ = true;
  return true;
}

bool RoutePlanner::replan_to_nearest(const Vec2& start, double clearance, Rng& rng) {
  clearance_m_ = clearance;
  const DiscDomain here = domain(start, goal_m_);
  const std::optional<Vec2> nearest = nearest_reachable(here, start, goal_m_);
  if (!nearest) return false;
  const DiscDomain there = here.with_goal_at(*nearest);
  const NamedPlanner& planner = exact();
  return follow(planner, there, planner.plan(there, start, budget(planner), rng));
}

std::optional<Route> RoutePlanner::route_from(const Vec2& start, Rng& rng) {
  is_searching_ = false;
  if (auto route = continued_from(start)) return route;
  remember_route();
  is_cut_short_ = false;
  bool is_found = find_detour(*planner_, start, rng) || (exact_ && find_detour(*exact_, start, rng)) ||
                  find_route(*planner_, start, rng);
  if (!is_found && exact_ && !may_continue_search()) {
    is_cut_short_ = false;
    is_found = find_route(*exact_, start, rng);
  }
  if (!is_found && may_continue_search()) {
    samples_ *= 2;
    is_searching_ = true;
    return std::nullopt;
  }
  if (!is_found && !find_route_to_nearest(start, rng)) return way_out(start);
  min_remaining_m_ = remaining_length_m(start);
  return route(min_remaining_m_);
}

std::optional<std::size_t> RoutePlanner::far_waypoint(const Vec2& start) const {
  double along_m = 0;
  Vec2 last = start;
  for (std::size_t i = 0; i + 1 < last_route_.size(); ++i) {
    along_m += (last_route_[i] - last).norm();
    last = last_route_[i];
    if (along_m < kFar_m) continue;
    for (std::size_t k = i + 1; k < last_route_.size(); ++k)
      if (world_->touches(last_route_[k - 1], last_route_[k], required_m_)) return std::nullopt;
    return i;
  }
  return std::nullopt;
}

bool RoutePlanner::find_detour(const NamedPlanner& planner, const Vec2& start, Rng& rng) {
  const std::optional<std::size_t> far = far_waypoint(start);
  if (!far || !replan_until(planner, start, *far, rng)) return false;
  waypoints_.insert(waypoints_.end(), last_route_.begin() + static_cast<std::ptrdiff_t>(*far) + 1,
                    last_route_.end());
  has_tight_end_ = has_last_tight_end_;
  return true;
}

bool RoutePlanner::replan_until(const NamedPlanner& planner, const Vec2& start, std::size_t waypoint,
                                Rng& rng) {
  const Vec2& via = last_route_[waypoint];
  const auto replan_with = [&](double clearance_m) {
    clearance_m_ = clearance_m;
    const DiscDomain here = domain(start, via);
    Budget near = budget(planner);
    near.samples = std::min(near.samples, kCycleSamples);
    return follow(planner, here, planner.plan(here, start, near, rng)) && waypoints_.back() == via;
  };
  return std::ranges::any_of(preferred_m_, replan_with) || replan_with(required_m_);
}

bool RoutePlanner::find_route(const NamedPlanner& planner, const Vec2& start, Rng& rng) {
  const double goal_clearance_m =
      obstacle_on_goal() ? std::numeric_limits<double>::infinity() : world_->nearest(goal_m_).distance_m;
  for (const double clearance : preferred_m_) {
    const bool is_last = clearance == preferred_m_.back();
    if (is_cut_short_) return false;
    if (goal_clearance_m > clearance) {
      if (replan(planner, start, clearance, rng)) return true;
    } else if (!is_last && replan_to_tight_goal(planner, start, clearance, rng)) {
      return true;
    }
  }
  return !is_cut_short_ && replan(planner, start, required_m_, rng);
}

bool RoutePlanner::find_route_to_nearest(const Vec2& start, Rng& rng) {
  for (const double clearance : preferred_m_)
    if (replan_to_nearest(start, clearance, rng)) return true;
  return replan_to_nearest(start, required_m_, rng);
}

std::optional<Route> RoutePlanner::way_out(const Vec2& start) {
  waypoints_.clear();
  has_tight_end_ = false;
  clearance_m_ = preferred_m_.back();
  const DiscDomain here = domain(start, start);
  if (!here.start_is_blocked()) return std::nullopt;
  const Vec2 free = here.goal(start);
  if (free == start) return std::nullopt;
  return Route{free, free, (free - start).norm(), free, false, true};
}

std::optional<Route> RoutePlanner::continued_from(const Vec2& start) {
  if (next_waypoint_ >= waypoints_.size()) return std::nullopt;
  while (next_waypoint_ + 1 < waypoints_.size() && may_skip_waypoint(start)) ++next_waypoint_;
  const double length = remaining_length_m(start);
  if (length > min_remaining_m_ + kReplanIncrease_m || !is_leg_free(start, next_waypoint_))
    return std::nullopt;
  min_remaining_m_ = std::min(min_remaining_m_, length);
  return route(length);
}

bool RoutePlanner::may_skip_waypoint(const Vec2& start) const {
  if (planner_->keeps_clear && (start - waypoints_[next_waypoint_]).norm() > kReached_m) return false;
  // The last leg must not be entered earlier, because it would then lead along obstacles.
  const bool is_before_tight_end = has_tight_end_ && next_waypoint_ + 2 == waypoints_.size();
  if (is_before_tight_end && (start - waypoints_[next_waypoint_]).norm() > kReached_m) return false;
  return is_leg_free(start, next_waypoint_ + 1);
}

double RoutePlanner::remaining_length_m(const Vec2& start) const {
  double length = (waypoints_[next_waypoint_] - start).norm();
  for (std::size_t i = next_waypoint_ + 1; i < waypoints_.size(); ++i)
    length += (waypoints_[i] - waypoints_[i - 1]).norm();
  return length;
}

Route RoutePlanner::route(double length) const {
  const Vec2& following = waypoints_[std::min(next_waypoint_ + 1, waypoints_.size() - 1)];
  return {waypoints_[next_waypoint_],   following, length, waypoints_.back(),
          waypoints_.back() == goal_m_, false};
}

}  // namespace sidestep
