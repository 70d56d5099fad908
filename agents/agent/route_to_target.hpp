// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "agents/agent/route_obstacles.hpp"
#include "agents/navigation/route_planner.hpp"
#include "agents/navigation/zone_map.hpp"
#include "agents/planning/named_planner.hpp"

namespace sidestep {

/// The robot's route to its target, around static obstacles, zones and temporary obstacles. A route that is
/// still free is kept for a while, even if there might be a shorter route. Inputs: the zones, and once per
/// cycle the target, the robot's place and the temporary obstacles. Output: the route.
class RouteToTarget {
 public:
  struct Query {
    Vec2 target_m{0, 0};
    Vec2 start_m{0, 0};  ///< where the route starts
    Vec2 robot_m{0, 0};  ///< where the robot is
    Time now{};
  };

  /// `extra_clearances_m` are the preferred clearances from obstacles beyond the required clearance, in
  /// descending order. They and `rules` must outlive this object.
  RouteToTarget(NamedPlanner planner, const FloorRules& rules, std::span<const double> extra_clearances_m);
  RouteToTarget(const RouteToTarget&) = delete;
  RouteToTarget& operator=(const RouteToTarget&) = delete;

  /// Replaces the zones, and discards the route.
  void set_zones(std::span<const Order> zones);
  /// Discards the route, because the robot has another goal.
  void forget() { has_route_ = false; }
  /// Records that obstacles have changed. The route is replaced once it is old or no longer free.
  void mark_outdated() { is_outdated_ = true; }
  /// Records that the robot is at its target.
  void on_arrival() { length_m_ = 0; }
  /// The next step of the route. If the planner finds no route, the step leads straight to the target.
  /// nullopt: the search continues in the next cycle.
  [[nodiscard]] std::optional<Route> find(const Query& query, std::span<const TemporaryObstacle> temporary,
                                          Rng& rng);

  /// The local methods of the planner; nullopt if it has none.
  const std::optional<LocalMethods>& local_methods() const { return planner_.local; }
  const ZoneMap& zones() const { return zones_; }
  /// Whether there has been a route since the goal or the zones last changed.
  bool has_route() const { return has_route_; }
  /// Length of the last route; 0 after an arrival.
  double length_m() const { return length_m_; }
  /// All obstacles that routes avoid. The first one returns nullptr before the first route and the first call
  /// of the second one.
  const RouteObstacles* known_obstacles() const { return obstacles_ ? &*obstacles_ : nullptr; }
  const RouteObstacles& obstacles();
  /// The obstacle that covers the target. Does not set the place to which the robot goes instead.
  /// Precondition: there has been a route.
  Blockage blockage() const;
  /// The last route, starting at its next waypoint. Precondition: there has been a route.
  std::span<const Vec2> remaining_waypoints_m() const { return route_planner_->remaining_waypoints_m(); }
  /// See RoutePlanner. Precondition: there has been a route.
  [[nodiscard]] bool is_line_free(const Vec2& from_m, const Vec2& to_m) const {
    return route_planner_->is_line_free(from_m, to_m);
  }

 private:
  /// Starts a new route if the target or the zones have changed. Also starts a new route if temporary
  /// obstacles have changed, unless the last route is free and recent.
  void replan_if_due(const Query& query, std::span<const TemporaryObstacle> temporary);

  const NamedPlanner planner_;
  const FloorRules& rules_;
  std::span<const double> extra_clearances_m_;
  ZoneMap zones_;
  std::optional<RouteObstacles> obstacles_;
  std::optional<RoutePlanner> route_planner_;  // uses planner_ and obstacles_
  bool has_route_ = false;
  bool is_outdated_ = false;  // obstacles have changed since routed_at_
  Time routed_at_{};
  double length_m_ = 0;
};

}  // namespace sidestep
