// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "agents/planning/visibility/lazy_visibility.hpp"
#include "common/collision/obstacle_world.hpp"
#include "common/geometry/circle.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// The next point to make for, and how far it is to the goal along the way.
struct Route {
  Vec2 waypoint_m{0, 0};
  double length_m = 0;
};

/// Shortest ways round discs to one goal, asked for every cycle. A way is kept for as long as it is free and
/// gets shorter, so that nobody wavers between two that are equally long.
class Ways {
 public:
  Ways(const Ways&) = delete;
  Ways& operator=(const Ways&) = delete;

  /// `margin_m`: so much more than its radius the robot's centre has to keep from the discs' edges; `extra_clearance_m`:
  /// and so much more it keeps where there is a way that does.
  Ways(const std::vector<Circle>& obstacles, const Field& field, double radius_m, double margin_m,
       double extra_clearance_m, const Vec2& goal_m);

  /// nullopt when there is no way from here, or none that can be found in a cycle. A start that is too near a
  /// disc may move away from it. Where the goal is too near one, the way leads to the nearest place that is
  /// not.
  std::optional<Route> route_from(const Vec2& start_m);
  /// Whether the straight way from one point to another is free; leaving a disc is.
  bool sees(const Vec2& from_m, const Vec2& to_m) const;

 private:
  /// Finds a way anew; whether there is one.
  bool find(const Vec2& start_m);
  /// What is left of the way that was found last, if it is still good.
  std::optional<Route> kept_from(const Vec2& start_m);
  double length_from(const Vec2& start_m) const;

  ObstacleWorld roomy_, tight_;
  const ObstacleWorld* world_ = &roomy_;  // of the last way
  Field field_;
  double radius_m_;
  Vec2 goal_m_;
  LazyVisibility planner_;
  Rng rng_{0};                // nothing is drawn
  std::vector<Vec2> points_;  // of the last way
  std::size_t next_ = 0;      // of them
  double length_m_ = 0;       // of what was left of it, at the least
};

}  // namespace sidestep
