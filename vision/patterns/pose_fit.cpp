// SPDX-License-Identifier: Apache-2.0
#include "vision/patterns/pose_fit.hpp"

#include <cmath>

namespace sidestep {

Pose fitted_pose(std::span<const SeenPoint> points) {
  Vec2 centre(0, 0), seen(0, 0);
  for (const SeenPoint& point : points) {
    centre += point.of_robot_m;
    seen += point.seen_m;
  }
  const auto count = static_cast<double>(points.size());
  centre /= count;
  seen /= count;
  double along = 0, across = 0;
  for (const SeenPoint& point : points) {
    const Vec2 r = point.of_robot_m - centre, s = point.seen_m - seen;
    along += r.dot(s);
    across += cross(r, s);
  }
  const double heading_rad = std::atan2(across, along);
  return {seen - rotated(centre, heading_rad), heading_rad};
}

double residual_m(const Pose& pose, std::span<const SeenPoint> points) {
  double sum = 0;
  for (const SeenPoint& point : points) sum += (point.seen_m - pose.to_world(point.of_robot_m)).squaredNorm();
  return std::sqrt(sum / static_cast<double>(points.size()));
}

}  // namespace sidestep
