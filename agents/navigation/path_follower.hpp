// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "common/geometry/vec2.hpp"

namespace sidestep {

/// Lengths in the unit of the path: metres, or pixels of an image.
struct PathFollowerSettings {
  double max_target_shift = 10;  ///< of the target, from where the path was planned to
  double max_deviation = 10;     ///< of the robot from the path
  double look_ahead = 20;        ///< from the robot's place on the path to the point that it drives to
};

/// Why a path has to be planned.
enum class ReplanReason {
  kNone,
  kNoPath,          ///< there is none
  kTargetLeftPlan,  ///< the target moved away from the path's end
  kRobotLeftPlan,   ///< the robot is too far from the path
};

/// Follows a path by the carrot method, and decides when to plan another one: only when the target or the
/// robot has left the plan. Obstacles are assumed not to move.
class PathFollower {
 public:
  explicit PathFollower(const PathFollowerSettings& settings = {}) : settings_(settings) {}

  /// Takes a path to `target`, which need not be the path's last point; empty: no path.
  void follow(std::span<const Vec2> path, const Vec2& target);
  ReplanReason replan_reason(const Vec2& robot, const Vec2& target) const;
  /// The point to drive to. It never moves backwards along the path. Without a path: the robot's position.
  Vec2 carrot(const Vec2& robot);
  std::span<const Vec2> path() const { return path_; }

 private:
  /// A place on the path: a share of the piece that begins at a point.
  struct Place {
    std::size_t piece = 0;
    double share = 0;
    Vec2 position{0, 0};
  };
  Place nearest_place(const Vec2& robot) const;

  PathFollowerSettings settings_;
  std::vector<Vec2> path_;
  Vec2 target_{0, 0};
  std::size_t first_piece_ = 0;  // pieces before it have been driven
};

}  // namespace sidestep
