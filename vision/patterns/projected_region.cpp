// SPDX-License-Identifier: Apache-2.0
#include "vision/patterns/projected_region.hpp"

#include <Eigen/LU>
#include <cmath>

namespace sidestep {

std::optional<double> px2_per_m2(const CameraModel& camera, const Vec3& point_m) {
  const auto jacobian = camera.projection_jacobian(point_m);
  if (!jacobian) return std::nullopt;
  const double scale = std::abs(jacobian->leftCols<2>().determinant());
  return scale > 0 ? std::optional(scale) : std::nullopt;
}

std::optional<ProjectedRegion> project_region(const Region& region, const CameraModel& camera,
                                              double height_m) {
  const auto position_m = camera.point_at({region.x_px, region.y_px}, height_m);
  if (!position_m) return std::nullopt;
  const auto scale = px2_per_m2(camera, {position_m->x(), position_m->y(), height_m});
  if (!scale) return std::nullopt;
  return ProjectedRegion{static_cast<Colour>(region.colour), *position_m, region.area_px / *scale};
}

}  // namespace sidestep
