// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/routed_robot.hpp"

#include <algorithm>
#include <cmath>

#include "agents/agent/planning_distances.hpp"
#include "deploy/audit/metrics/run_metrics.hpp"

namespace sidestep {
namespace {

/// The speed from which a robot stops at a distance if it drives on for one cycle before it brakes.
double stopping_speed_mps(double distance_m, double deceleration_mps2, double cycle_s) {
  const double per_cycle_mps = deceleration_mps2 * cycle_s;
  return std::sqrt(per_cycle_mps * per_cycle_mps + 2 * deceleration_mps2 * distance_m) - per_cycle_mps;
}

}  // namespace

RoutedRobot::RoutedRobot(const RobotSpec& spec, double goal_tolerance_m, const FloorRules& rules,
                         const NamedPlanner& planner, const ObstacleWorld& world)
    : spec_(spec),
      goal_tolerance_m_(goal_tolerance_m),
      floor_limits_(rules.limits),
      limits_(rules.limits),
      routes_(planner, world, rules.field, rules.radius_m, rules.margin_m, {&kExtraClearance_m, 1}),
      state_{spec.start_m, {0, 0}} {
  begin_goal();
}

void RoutedRobot::begin_goal() {
  const Goal goal = spec_.goals.empty() ? Goal{spec_.start_m} : spec_.goals[goal_];
  goal_m_ = goal.position_m;
  limits_ = limits_to(goal, floor_limits_);
  routes_.begin(goal_m_);
}

Vec2 RoutedRobot::preferred_mps(double cycle_s, Rng& rng) {
  const std::optional<Route> route = routes_.route_from(state_.position_m, rng);
  if (!route) return {0, 0};
  const Vec2 offset_m = route->waypoint_m - state_.position_m;
  const double distance_m = offset_m.norm();
  if (distance_m == 0) return {0, 0};
  const double stopping_mps = stopping_speed_mps(route->length_m, limits_.deceleration_mps2, cycle_s);
  return offset_m * (std::min(limits_.speed_mps, stopping_mps) / distance_m);
}

void RoutedRobot::move(const Vec2& acceleration_mps2, double cycle_s, double end_s) {
  state_ = state_after(state_, acceleration_mps2, cycle_s);
  update_arrival(end_s);
}

void RoutedRobot::update_arrival(double now_s) {
  const double tolerance_m =
      is_last_goal() ? goal_tolerance_m_ : spec_.goals[goal_].tolerance_m.value_or(goal_tolerance_m_);
  const bool is_settled = (goal_m_ - state_.position_m).norm() <= tolerance_m &&
                          state_.velocity_mps.norm() < RunMetrics::kAtRest_mps;
  if (is_settled && !is_last_goal()) {
    ++goal_;
    begin_goal();
  } else if (!is_settled) {
    settled_since_s_.reset();
  } else if (!settled_since_s_) {
    settled_since_s_ = now_s;
  }
}

}  // namespace sidestep
