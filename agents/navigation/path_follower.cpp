// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/path_follower.hpp"

#include <algorithm>

namespace sidestep {

void PathFollower::follow(std::span<const Vec2> path, const Vec2& target) {
  path_.assign(path.begin(), path.end());
  target_ = target;
  first_piece_ = 0;
}

PathFollower::Place PathFollower::nearest_place(const Vec2& robot) const {
  Place nearest{0, 0, path_.front()};
  if (path_.size() == 1) return nearest;
  double nearest2 = -1;
  for (std::size_t i = first_piece_; i + 1 < path_.size(); ++i) {
    const Vec2 along = path_[i + 1] - path_[i];
    const double square = along.squaredNorm();
    const double share = square > 0 ? std::clamp(along.dot(robot - path_[i]) / square, 0.0, 1.0) : 0.0;
    const Vec2 position = path_[i] + share * along;
    const double distance2 = (robot - position).squaredNorm();
    if (nearest2 >= 0 && distance2 >= nearest2) continue;
    nearest2 = distance2;
    nearest = {i, share, position};
  }
  return nearest;
}

ReplanReason PathFollower::replan_reason(const Vec2& robot, const Vec2& target) const {
  if (path_.empty()) return ReplanReason::kNoPath;
  if ((target - target_).norm() > settings_.max_target_shift) return ReplanReason::kTargetLeftPlan;
  if ((robot - nearest_place(robot).position).norm() > settings_.max_deviation)
    return ReplanReason::kRobotLeftPlan;
  return ReplanReason::kNone;
}

Vec2 PathFollower::carrot(const Vec2& robot) {
  if (path_.empty()) return robot;
  const Place place = nearest_place(robot);
  first_piece_ = place.piece;
  Vec2 from = place.position;
  double rest = settings_.look_ahead;
  for (std::size_t i = place.piece + 1; i < path_.size(); ++i) {
    const double length = (path_[i] - from).norm();
    if (length >= rest) return from + rest / length * (path_[i] - from);
    rest -= length;
    from = path_[i];
  }
  return path_.back();
}

}  // namespace sidestep
