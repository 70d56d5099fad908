// SPDX-License-Identifier: Apache-2.0
#include "simulator/rendering/footprint.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {

cv::Rect footprint(const CameraModel& camera, const Vec2& place_m, double radius_m, double low_m,
                   double high_m) {
  Vec2 low(1e9, 1e9), high(-1e9, -1e9);
  for (const double z : {low_m, high_m}) {
    for (const double x : {-radius_m, radius_m}) {
      for (const double y : {-radius_m, radius_m}) {
        const auto pixel = camera.pixel_of(Vec3(place_m.x() + x, place_m.y() + y, z));
        if (!pixel) return {};
        low = low.cwiseMin(*pixel);
        high = high.cwiseMax(*pixel);
      }
    }
  }
  const CameraParameters& p = camera.parameters();
  // Excludes coordinates that do not fit into int.
  if (high.x() < -2 || high.y() < -2 || low.x() > p.width_px + 1.0 || low.y() > p.height_px + 1.0) return {};
  const Vec2 min(-2, -2), max(p.width_px + 2.0, p.height_px + 2.0);
  low = low.cwiseMax(min).array().floor() - 1;
  high = high.cwiseMin(max).array().ceil() + 1;
  const cv::Rect rect(cv::Point(int(low.x()), int(low.y())), cv::Point(int(high.x()) + 1, int(high.y()) + 1));
  return rect & cv::Rect(0, 0, p.width_px, p.height_px);
}

double pixel_reach_m(const Eigen::Matrix2d& metres_per_pixel) {
  const Vec2 a = metres_per_pixel.col(0) + metres_per_pixel.col(1);
  const Vec2 b = metres_per_pixel.col(0) - metres_per_pixel.col(1);
  return 0.55 * std::sqrt(std::max(a.squaredNorm(), b.squaredNorm()));
}

}  // namespace sidestep
