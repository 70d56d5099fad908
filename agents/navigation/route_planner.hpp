// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "agents/planning/named_planner.hpp"
#include "agents/planning/smoothing/leader_follower.hpp"
#include "common/collision/obstacle_world.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// The next waypoint of a route.
struct Route {
  Vec2 waypoint_m{0, 0};
  Vec2 following_m{0, 0};  ///< where the route leads from the waypoint
  double length_m = 0;     ///< of the remaining route
  Vec2 end_m{0, 0};        ///< the goal, or the nearest place that can be reached
  bool reaches_goal = true;
  bool is_way_out = false;  ///< leads straight out of several obstacles, whatever lies between
};

/// Plans routes around obstacles, once per control cycle. A route is kept while it is
/// free and its remaining length does not grow, so that the robot does not alternate between two routes of
/// equal length. Grids miss narrow passages, and random samples may: if the planner finds no path, the lazy
/// visibility graph decides whether there is one. If obstacles cover or enclose the goal, routes lead to the
/// nearest place that can be reached. On large floors, the search for a route may take several cycles, and
/// a new route around changed obstacles keeps the part of the last one that is far away.
class RoutePlanner {
 public:
  RoutePlanner(const RoutePlanner&) = delete;
  RoutePlanner& operator=(const RoutePlanner&) = delete;

  /// The robot's centre keeps at least `radius_m + margin_m` from the obstacles, and the first of the extra
  /// clearances, in descending order, with which a route exists. A goal that is nearer to an obstacle is
  /// reached on a straight line from the nearest place with that clearance, unless it is the last one. The
  /// planner of the paths, one of kDrivingPlanners, and the
  /// obstacles have to outlive this object.
  RoutePlanner(const NamedPlanner& planner, const ObstacleWorld& obstacles, const Field& field,
               double radius_m, double margin_m, std::span<const double> extra_clearances_m);

  /// Gives up the last route: for another goal, or when obstacles have changed; its end may become the end of
  /// the next route to the same goal. Call it before all others.
  void begin(const Vec2& goal_m);
  const Vec2& goal_m() const { return goal_m_; }

  /// Returns nullopt if no route is found within the sample budget of a cycle. A start that is too near an
  /// obstacle may be left on a straight line away from it. If several obstacles leave no such line, the route
  /// leads straight to the nearest free position.
  [[nodiscard]] std::optional<Route> route_from(const Vec2& start_m, Rng& rng);
  /// Whether the last call of route_from() found no route because the search takes longer than one cycle. It
  /// goes on with the next call.
  bool is_searching() const { return is_searching_; }
  /// What it took to find the last route, in cycles; at least one.
  double effort() const { return static_cast<double>(samples_) / static_cast<double>(kCycleSamples); }
  /// The last route from its next waypoint on.
  std::span<const Vec2> remaining_waypoints_m() const {
    return std::span(waypoints_).subspan(std::min(next_waypoint_, waypoints_.size()));
  }
  /// Whether the straight line between two points is free for the robot, in the world of the last route. A
  /// line that leads out of an obstacle counts as free.
  [[nodiscard]] bool is_line_free(const Vec2& from_m, const Vec2& to_m) const;
  /// Whether the last route is free from a position on it, in spite of obstacles that have changed.
  [[nodiscard]] bool is_free_from(const Vec2& start_m) const;
  /// The obstacle that covers the goal most deeply; nullopt if none does.
  [[nodiscard]] std::optional<ObstacleId> obstacle_on_goal() const;

 private:
  Field extended_field() const;
  DiscDomain domain(const Vec2& start_m, const Vec2& goal_m) const;
  /// Plans a new route that keeps this distance from obstacles. Returns whether one leads to the goal or, if
  /// an obstacle covers it, to the nearest place.
  bool replan(const NamedPlanner& planner, const Vec2& start_m, double clearance_m, Rng& rng);
  /// As replan(), for a goal that is nearer to an obstacle than this.
  bool replan_to_tight_goal(const NamedPlanner& planner, const Vec2& start_m, double clearance_m, Rng& rng);
  /// Plans a new route with the largest clearance possible. Returns whether there is one.
  bool find_route(const NamedPlanner& planner, const Vec2& start_m, Rng& rng);
  void remember_route();
  /// Plans a route that leads around what has changed nearby and then along the last route. Returns whether
  /// the last route is so long, and there is one.
  bool find_detour(const NamedPlanner& planner, const Vec2& start_m, Rng& rng);
  bool replan_until(const NamedPlanner& planner, const Vec2& start_m, std::size_t waypoint, Rng& rng);
  /// Where the last route may be joined: its first waypoint that is far away, if all beyond it is free.
  std::optional<std::size_t> far_waypoint(const Vec2& start_m) const;
  /// Whether a search of this cycle spent its budget, and the next one may take longer.
  bool may_go_on() const { return is_cut_short_ && samples_ < kMostSamples; }
  Budget budget(const NamedPlanner& planner) const;
  bool may_skip_waypoint(const Vec2& start_m) const;
  /// Plans a new route to the nearest place that can be reached.
  bool replan_to_nearest(const Vec2& start_m, double clearance_m, Rng& rng);
  bool find_route_to_nearest(const Vec2& start_m, Rng& rng);
  /// Joins states of a path that are almost on a straight line.
  void take_straightened(std::span<const Vec2> path_m);
  bool follow(const NamedPlanner& planner, const DiscDomain& domain, const Plan<Vec2>& plan);
  /// The planner whose answer that there is no path can be relied on.
  const NamedPlanner& exact() const { return exact_ ? *exact_ : *planner_; }
  /// Whether the line from a position to a waypoint is free for the robot.
  bool is_leg_free(const Vec2& from_m, std::size_t waypoint) const;
  /// The straight line from a blocked start to the nearest free position.
  std::optional<Route> way_out(const Vec2& start_m);
  /// The rest of the last route, if that is still free and not longer.
  std::optional<Route> continued_from(const Vec2& start_m);
  double remaining_length_m(const Vec2& start_m) const;
  Route route(double length_m) const;

  /// Of a search in one cycle: enough for about a hundred obstacles.
  static constexpr std::size_t kCycleSamples = 5000;
  /// Enough for buildings of 100 by 100 m. Without a route, the robot heads straight for its goal while that
  /// is safe.
  static constexpr std::size_t kMostSamples = 64 * kCycleSamples;

  const ObstacleWorld* world_;
  Field field_;
  double radius_m_;
  double required_m_;                // distance of the robot's centre from obstacles
  std::vector<double> preferred_m_;  // the same, descending
  double clearance_m_;               // of the last route
  bool has_tight_end_ = false;       // the last leg of the route keeps only the required distance
  Vec2 goal_m_{0, 0};
  const NamedPlanner* planner_;
  std::optional<NamedPlanner> exact_;  // unless planner_ is
  DiscDomainSettings domain_settings_;
  std::vector<Vec2> waypoints_;  // of the last route
  std::size_t next_waypoint_ = 0;
  std::vector<Vec2> last_route_;  // from the next waypoint on, before begin(); empty: none to this goal
  bool has_last_tight_end_ = false;
  std::size_t samples_ = kCycleSamples;  // of one search
  bool is_cut_short_ = false;            // a search of this cycle spent its budget
  bool is_searching_ = false;
  double min_remaining_m_ = 0;  // smallest remaining length of the last route so far
};

}  // namespace sidestep
