// SPDX-License-Identifier: Apache-2.0
#include "vision/patterns/pose_fit.hpp"

#include <cmath>

namespace sidestep {

Pose fit_pose(std::span<const PointCorrespondence> points) {
  Vec2 body_centroid(0, 0), observed_centroid(0, 0);
  for (const PointCorrespondence& point : points) {
    body_centroid += point.body_m;
    observed_centroid += point.observed_m;
  }
  const auto count = static_cast<double>(points.size());
  body_centroid /= count;
  observed_centroid /= count;
  double dot_sum = 0, cross_sum = 0;
  for (const PointCorrespondence& point : points) {
    const Vec2 body = point.body_m - body_centroid, observed = point.observed_m - observed_centroid;
    dot_sum += body.dot(observed);
    cross_sum += cross(body, observed);
  }
  const double heading_rad = std::atan2(cross_sum, dot_sum);
  return {observed_centroid - rotated(body_centroid, heading_rad), heading_rad};
}

double rms_residual_m(const Pose& pose, std::span<const PointCorrespondence> points) {
  double sum = 0;
  for (const PointCorrespondence& point : points)
    sum += (point.observed_m - pose.to_world(point.body_m)).squaredNorm();
  return std::sqrt(sum / static_cast<double>(points.size()));
}

}  // namespace sidestep
