// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/route_planner.hpp"

#include <algorithm>

namespace sidestep {
namespace {

// A route is replanned if its remaining length exceeds the smallest one so far by more than this.
constexpr double kReplanIncrease_m = 0.05;
// Enough for about a hundred obstacles. Without a route the robot heads straight for its goal while that is
// safe.
constexpr std::size_t kMaxSamples = 5000;

std::vector<Shape> inflated(const std::vector<Circle>& obstacles, double inflation_m) {
  std::vector<Shape> shapes;
  shapes.reserve(obstacles.size());
  for (const Circle& circle : obstacles)
    shapes.push_back(Circle{circle.centre_m, circle.radius_m + inflation_m});
  return shapes;
}

}  // namespace

RoutePlanner::RoutePlanner(const std::vector<Circle>& obstacles, const Field& field, double radius_m,
                           double margin_m, double extra_clearance_m, const Vec2& goal_m)
    : preferred_world_(inflated(obstacles, margin_m + extra_clearance_m)),
      required_world_(inflated(obstacles, margin_m)),
      field_(field),
      radius_m_(radius_m),
      goal_m_(goal_m) {}

bool RoutePlanner::is_line_free(const Vec2& from, const Vec2& to) const {
  return DiscDomain(*world_, field_, radius_m_, from, to).check(from, to);
}

bool RoutePlanner::replan(const Vec2& start) {
  const DiscDomain domain(*world_, field_, radius_m_, start, goal_m_);
  Budget budget;
  budget.samples = kMaxSamples;
  const Plan<Vec2>& plan = planner_.plan(domain, start, budget, rng_);
  next_waypoint_ = 0;
  waypoints_.clear();
  if (plan.arrives()) waypoints_.assign(plan.states.begin() + 1, plan.states.end());
  return !waypoints_.empty();
}

std::optional<Route> RoutePlanner::route_from(const Vec2& start) {
  if (const auto route = continued_from(start)) return route;
  world_ = &preferred_world_;
  if (!replan(start)) {
    world_ = &required_world_;
    if (!replan(start)) return std::nullopt;
  }
  min_remaining_m_ = remaining_length_m(start);
  return Route{waypoints_.front(), min_remaining_m_};
}

std::optional<Route> RoutePlanner::continued_from(const Vec2& start) {
  if (next_waypoint_ >= waypoints_.size()) return std::nullopt;
  while (next_waypoint_ + 1 < waypoints_.size() && is_line_free(start, waypoints_[next_waypoint_ + 1]))
    ++next_waypoint_;
  const double length = remaining_length_m(start);
  if (length > min_remaining_m_ + kReplanIncrease_m || !is_line_free(start, waypoints_[next_waypoint_]))
    return std::nullopt;
  min_remaining_m_ = std::min(min_remaining_m_, length);
  return Route{waypoints_[next_waypoint_], length};
}

double RoutePlanner::remaining_length_m(const Vec2& start) const {
  double length = (waypoints_[next_waypoint_] - start).norm();
  for (std::size_t i = next_waypoint_ + 1; i < waypoints_.size(); ++i)
    length += (waypoints_[i] - waypoints_[i - 1]).norm();
  return length;
}

}  // namespace sidestep
