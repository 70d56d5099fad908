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
  Vec2 next_waypoint_m{0, 0};  ///< where the route continues after the waypoint
  double length_m = 0;         ///< length of the remaining route
  Vec2 end_m{0, 0};            ///< the goal, or the nearest place that can be reached
  bool reaches_goal = true;
  /// Whether the route leads straight out of several overlapping obstacles, through everything in between.
  bool is_way_out = false;
};

/// Plans routes around obstacles, once per control cycle. A route is kept while it is free and its remaining
/// length does not grow, so that the robot does not alternate between two routes of equal length. Grids miss
/// narrow passages, and so may random samples. Therefore, if the planner finds no path, the lazy visibility
/// graph decides whether a path exists. If obstacles cover or enclose the goal, routes lead to the nearest
/// place that can be reached. On large floors, the search for a route may take several cycles, and a new
/// route around changed obstacles keeps the part of the last route that is far away.
class RoutePlanner {
 public:
  RoutePlanner(const RoutePlanner&) = delete;
  RoutePlanner& operator=(const RoutePlanner&) = delete;

  /// The robot's centre keeps at least `radius_m + margin_m` from the obstacles, plus the largest of the
  /// extra clearances with which a route exists; they are given in descending order. If the goal has less
  /// clearance than that, the route ends with a straight line from the nearest place with that clearance,
  /// unless that is the last (smallest) clearance. The path planner, one of kDrivingPlanners, and the
  /// obstacles must outlive this object.
  RoutePlanner(const NamedPlanner& planner, const ObstacleWorld& obstacles, const Field& field,
               double radius_m, double margin_m, std::span<const double> extra_clearances_m);

  /// Discards the last route, for another goal or because obstacles have changed. Its end may become the end
  /// of the next route to the same goal. Call this before all other functions.
  void begin(const Vec2& goal_m);
  const Vec2& goal_m() const { return goal_m_; }

  /// Returns nullopt if no route is found within the sample budget of a cycle. A start that is too near an
  /// obstacle may be left in a straight line away from it. If several obstacles leave no such line, the route
  /// leads straight to the nearest free position.
  [[nodiscard]] std::optional<Route> route_from(const Vec2& start_m, Rng& rng);
  /// Whether the last call of route_from() found no route because the search takes more than one cycle. The
  /// next call continues it.
  bool is_searching() const { return is_searching_; }
  /// The effort of finding the last route, in cycles; at least one.
  double effort() const { return static_cast<double>(samples_) / static_cast<double>(kCycleSamples); }
  /// The last route, starting at its next waypoint.
  std::span<const Vec2> remaining_waypoints_m() const {
    return std::span(waypoints_).subspan(std::min(next_waypoint_, waypoints_.size()));
  }
  /// Whether the straight line between two points is free for the robot, in the world of the last route. A
  /// line that leads out of an obstacle counts as free.
  [[nodiscard]] bool is_line_free(const Vec2& from_m, const Vec2& to_m) const;
  /// Whether the last route is free from a position on it to its end, even though obstacles have changed.
  [[nodiscard]] bool is_free_from(const Vec2& start_m) const;
  /// The obstacle that covers the goal most deeply; nullopt if none does.
  [[nodiscard]] std::optional<ObstacleId> obstacle_on_goal() const;

 private:
  Field extended_field() const;
  DiscDomain domain(const Vec2& start_m, const Vec2& goal_m) const;
  /// Plans a new route that keeps this distance from obstacles. Returns whether the route leads to the goal
  /// or, if an obstacle covers the goal, to the nearest free place.
  bool replan(const NamedPlanner& planner, const Vec2& start_m, double clearance_m, Rng& rng);
  /// Like replan(), but for a goal that is nearer to an obstacle than this distance.
  bool replan_to_tight_goal(const NamedPlanner& planner, const Vec2& start_m, double clearance_m, Rng& rng);
  /// Plans a new route with the largest possible clearance. Returns whether it found a route.
  bool find_route(const NamedPlanner& planner, const Vec2& start_m, Rng& rng);
  void remember_route();
  /// Plans a route that leads around changes nearby and then along the last route. Returns whether it
  /// succeeded; it requires a long last route.
  bool find_detour(const NamedPlanner& planner, const Vec2& start_m, Rng& rng);
  bool replan_until(const NamedPlanner& planner, const Vec2& start_m, std::size_t waypoint, Rng& rng);
  /// The waypoint at which the last route may be joined: the first distant waypoint, if the route beyond it
  /// is free.
  std::optional<std::size_t> far_waypoint(const Vec2& start_m) const;
  /// Whether a search in this cycle has spent its budget and may be continued with a larger one in the next.
  bool may_continue_search() const { return is_cut_short_ && samples_ < kMaxTotalSamples; }
  Budget budget(const NamedPlanner& planner) const;
  bool may_skip_waypoint(const Vec2& start_m) const;
  /// Plans a new route to the nearest place that can be reached.
  bool replan_to_nearest(const Vec2& start_m, double clearance_m, Rng& rng);
  bool find_route_to_nearest(const Vec2& start_m, Rng& rng);
  /// Stores a path without the states that lie almost on a straight line.
  void store_straightened(std::span<const Vec2> path_m);
  bool follow(const NamedPlanner& planner, const DiscDomain& domain, const Plan<Vec2>& plan);
  /// The planner whose failure proves that there is no path.
  const NamedPlanner& exact() const { return exact_ ? *exact_ : *planner_; }
  /// Whether the line from a position to a waypoint is free for the robot.
  bool is_leg_free(const Vec2& from_m, std::size_t waypoint) const;
  /// A straight route from a blocked start to the nearest free position.
  std::optional<Route> way_out(const Vec2& start_m);
  /// The rest of the last route, if it is still free and has not become longer.
  std::optional<Route> continued_from(const Vec2& start_m);
  double remaining_length_m(const Vec2& start_m) const;
  Route route(double length_m) const;

  /// Samples per search in one cycle: enough for about a hundred obstacles.
  static constexpr std::size_t kCycleSamples = 5000;
  /// Maximum samples per search: enough for buildings of 100 by 100 m. Without a route, the robot heads
  /// straight for its goal while that is safe.
  static constexpr std::size_t kMaxTotalSamples = 64 * kCycleSamples;

  const ObstacleWorld* world_;
  Field field_;
  double radius_m_;
  double required_m_;                // required distance of the robot's centre from obstacles
  std::vector<double> preferred_m_;  // preferred distances, descending
  double clearance_m_;               // distance that the last route keeps
  bool has_tight_end_ = false;       // the last leg of the route keeps only the required distance
  Vec2 goal_m_{0, 0};
  const NamedPlanner* planner_;
  std::optional<NamedPlanner> exact_;  // set unless planner_ is exact
  DiscDomainSettings domain_settings_;
  std::vector<Vec2> waypoints_;  // waypoints of the last route
  std::size_t next_waypoint_ = 0;
  std::vector<Vec2> last_route_;  // remaining last route before begin(); empty: there is none to this goal
  bool has_last_tight_end_ = false;
  std::size_t samples_ = kCycleSamples;  // budget of one search
  bool is_cut_short_ = false;            // a search of this cycle spent its budget
  bool is_searching_ = false;
  double min_remaining_m_ = 0;  // smallest remaining length of the last route so far
};

}  // namespace sidestep
