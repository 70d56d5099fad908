// SPDX-License-Identifier: Apache-2.0
#include "vision/patterns/patch.hpp"

#include <Eigen/LU>
#include <cmath>

namespace sidestep {

std::optional<double> px2_per_m2(const CameraModel& camera, const Vec3& point_m) {
  const auto moves = camera.pixels_per_metre(point_m);
  if (!moves) return std::nullopt;
  const double covered = std::abs(moves->leftCols<2>().determinant());
  return covered > 0 ? std::optional(covered) : std::nullopt;
}

std::optional<Patch> patch_of(const Region& region, const CameraModel& camera, double height_m) {
  const auto position_m = camera.point_at({region.x_px, region.y_px}, height_m);
  if (!position_m) return std::nullopt;
  const auto covered = px2_per_m2(camera, {position_m->x(), position_m->y(), height_m});
  if (!covered) return std::nullopt;
  return Patch{static_cast<Colour>(region.colour), *position_m, region.area_px / *covered};
}

}  // namespace sidestep
