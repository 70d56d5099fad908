// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "common/geometry/vec2.hpp"

namespace sidestep {

/// Settings. Lengths are in the unit of the path: metres, or pixels of an image.
struct PathFollowerSettings {
  double max_target_shift = 10;  ///< maximum distance of the target from the end of the plan
  double max_deviation = 10;     ///< maximum distance of the robot from the path
  double look_ahead = 20;        ///< distance along the path from the robot to the point that it drives to
};

/// Why a new path must be planned.
enum class ReplanReason {
  kNone,
  kNoPath,          ///< there is no path
  kTargetLeftPlan,  ///< the target moved away from the path's end
  kRobotLeftPlan,   ///< the robot is too far from the path
};

/// Follows a path by the carrot method, and requests a new path when the target or the robot has left the
/// plan. Assumes that obstacles do not move.
class PathFollower {
 public:
  explicit PathFollower(const PathFollowerSettings& settings = {}) : settings_(settings) {}

  /// Starts following a path to `target`, which need not be the path's last point. An empty path means no
  /// path.
  void follow(std::span<const Vec2> path, const Vec2& target);
  ReplanReason replan_reason(const Vec2& robot, const Vec2& target) const;
  /// The point to drive to. It never moves backwards along the path. Without a path it is the robot's
  /// position.
  Vec2 carrot(const Vec2& robot);
  std::span<const Vec2> path() const { return path_; }

 private:
  /// A place on the path: the index of a piece between two points, and the fraction of this piece.
  struct Place {
    std::size_t piece = 0;
    double share = 0;
    Vec2 position{0, 0};
  };
  Place nearest_place(const Vec2& robot) const;

  PathFollowerSettings settings_;
  std::vector<Vec2> path_;
  Vec2 target_{0, 0};
  std::size_t first_piece_ = 0;  // the robot has driven past all earlier pieces
};

}  // namespace sidestep
