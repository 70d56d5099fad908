// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <span>

#include "common/camera/camera_model.hpp"
#include "common/geometry/circle.hpp"
#include "common/geometry/segment.hpp"

namespace sidestep {

/// Vertical cylinders of equal height that stand on the floor. The circles must outlive it.
struct VerticalCylinders {
  std::span<const Circle> circles;
  double height_m = 0;
};

/// Whether one of the cylinders intersects the line of sight from the camera to a point on the floor. A
/// cylinder as high as the camera occludes everything behind it. Precondition: the camera is above the floor.
inline bool is_occluded(const Vec2& floor_m, const VerticalCylinders& cylinders, const CameraModel& camera) {
  const Vec3& eye_m = camera.position_m();
  const double height_ratio = std::min(1.0, cylinders.height_m / eye_m.z());
  const Segment low_ray{floor_m, floor_m + height_ratio * (eye_m.head<2>() - floor_m)};
  return std::ranges::any_of(cylinders.circles, [&](const Circle& circle) {
    return squared_distance(circle.centre_m, low_ray) <= circle.radius_m * circle.radius_m;
  });
}

}  // namespace sidestep
