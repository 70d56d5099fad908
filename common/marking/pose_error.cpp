// SPDX-License-Identifier: Apache-2.0
#include "common/marking/pose_error.hpp"

#include <cmath>

namespace sidestep {

PoseError predicted_pose_error(const MarkingLayout& layout, double dot_sd_m) {
  const double count = static_cast<double>(layout.dots.size()) + 1;
  Vec2 centroid_m = layout.centre.position_m;
  for (const MarkingDot& dot : layout.dots) centroid_m += dot.position_m;
  centroid_m /= count;
  double squares_m2 = (layout.centre.position_m - centroid_m).squaredNorm();
  for (const MarkingDot& dot : layout.dots) squares_m2 += (dot.position_m - centroid_m).squaredNorm();

  PoseError error;
  error.centroid_m = dot_sd_m / std::sqrt(count);
  error.heading_rad = dot_sd_m / std::sqrt(squares_m2);
  error.ahead_m = std::hypot(error.centroid_m, error.heading_rad * centroid_m.y());
  error.aside_m = std::hypot(error.centroid_m, error.heading_rad * centroid_m.x());
  return error;
}

}  // namespace sidestep
