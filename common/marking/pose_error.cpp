// SPDX-License-Identifier: Apache-2.0
#include "common/marking/pose_error.hpp"

#include <cmath>

namespace sidestep {

PoseError predicted_pose_error(const MarkerLayout& layout, double marker_sd_m) {
  const double count = static_cast<double>(layout.dots.size()) + 1;
  Vec2 centroid_m = layout.centre.position_m;
  for (const Marker& dot : layout.dots) centroid_m += dot.position_m;
  centroid_m /= count;
  double sum_of_squares_m2 = (layout.centre.position_m - centroid_m).squaredNorm();
  for (const Marker& dot : layout.dots) sum_of_squares_m2 += (dot.position_m - centroid_m).squaredNorm();

  PoseError error;
  error.centroid_m = marker_sd_m / std::sqrt(count);
  error.heading_rad = marker_sd_m / std::sqrt(sum_of_squares_m2);
  error.longitudinal_m = std::hypot(error.centroid_m, error.heading_rad * centroid_m.y());
  error.lateral_m = std::hypot(error.centroid_m, error.heading_rad * centroid_m.x());
  return error;
}

}  // namespace sidestep
