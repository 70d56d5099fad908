// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "common/geometry/circle.hpp"
#include "common/geometry/field.hpp"

namespace sidestep {

/// The next point to make for, and how far it is to the goal along the way.
struct Route {
  Vec2 waypoint_m{0, 0};
  double length_m = 0;
};

/// Shortest ways round discs to one goal: corners of a polygon round each disc, joined where they see each
/// other, with the distance to the goal known for each (Dijkstra from the goal). Built once for a goal, asked
/// every cycle.
class VisibilityGraph {
 public:
  /// `keep_m`: the distance that the robot's centre keeps from the discs' edges.
  VisibilityGraph(const std::vector<Circle>& obstacles, const Field& field, double radius_m, double keep_m,
                  const Vec2& goal_m);

  /// nullopt when no way to the goal can be seen from here. A start that is too near a disc may move away
  /// from it.
  std::optional<Route> route_from(const Vec2& start_m) const;
  /// Whether the straight way from one point to another is free; leaving a disc is.
  bool sees(const Vec2& from, const Vec2& to) const;

 private:
  struct Corner {
    Vec2 position_m;
    double to_goal_m;  // infinity: no way
  };
  void place_corners(const Field& field, double radius_m);
  /// Dijkstra from the goal.
  void measure();

  std::vector<Circle> discs_;    // grown: the centre stays out of them
  std::vector<Corner> corners_;  // the goal is the first
};

}  // namespace sidestep
