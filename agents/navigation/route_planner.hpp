// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "agents/planning/visibility/lazy_visibility.hpp"
#include "common/collision/obstacle_world.hpp"
#include "common/geometry/circle.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// The next waypoint, and the length of the remaining route to the goal.
struct Route {
  Vec2 waypoint_m{0, 0};
  double length_m = 0;
};

/// Plans shortest routes around discs to one goal, once per control cycle. A route is kept while it is free
/// and its remaining length does not grow, so that the robot does not alternate between two routes of equal
/// length.
class RoutePlanner {
 public:
  RoutePlanner(const RoutePlanner&) = delete;
  RoutePlanner& operator=(const RoutePlanner&) = delete;

  /// The robot's centre keeps at least `radius_m + margin_m` from the edges of the discs, and
  /// `extra_clearance_m` more where a route with that clearance exists.
  RoutePlanner(const std::vector<Circle>& obstacles, const Field& field, double radius_m, double margin_m,
               double extra_clearance_m, const Vec2& goal_m);

  /// Returns nullopt if there is no route, or none within the sample budget of a cycle. A start that is too
  /// near a disc may be left on a straight line away from it. If the goal is too near a disc, the route leads
  /// to the nearest free position.
  [[nodiscard]] std::optional<Route> route_from(const Vec2& start_m);
  /// Whether the straight line between two points is free for the robot, in the world of the last route. A
  /// line that leads out of a disc counts as free.
  [[nodiscard]] bool is_line_free(const Vec2& from_m, const Vec2& to_m) const;

 private:
  /// Plans a new route in world_; returns whether one exists.
  bool replan(const Vec2& start_m);
  /// The rest of the last route, if that is still free and not longer.
  std::optional<Route> continued_from(const Vec2& start_m);
  double remaining_length_m(const Vec2& start_m) const;

  ObstacleWorld preferred_world_;                   // obstacles inflated by margin and extra clearance
  ObstacleWorld required_world_;                    // obstacles inflated by the margin
  const ObstacleWorld* world_ = &preferred_world_;  // of the last route
  Field field_;
  double radius_m_;
  Vec2 goal_m_;
  LazyVisibility planner_;
  Rng rng_{0};                   // required by the planner interface; never sampled
  std::vector<Vec2> waypoints_;  // of the last route
  std::size_t next_waypoint_ = 0;
  double min_remaining_m_ = 0;  // smallest remaining length of the last route so far
};

}  // namespace sidestep
