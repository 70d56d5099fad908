// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <span>

#include "common/camera/camera_model.hpp"
#include "common/geometry/circle.hpp"
#include "common/geometry/segment.hpp"

namespace sidestep {

/// Round things that stand upright, all of one height. The circles must outlive it.
struct Uprights {
  std::span<const Circle> circles;
  double height_m = 0;
};

/// Whether one of them lies on the line of sight from the camera to a point of the floor. What is as high as
/// the camera hides all that lies behind it. Precondition: the camera hangs over the floor.
inline bool hide(const Uprights& uprights, const Vec2& floor_m, const CameraModel& camera) {
  const Vec3& eye_m = camera.position_m();
  const double share = std::min(1.0, uprights.height_m / eye_m.z());
  const Segment sight{floor_m, floor_m + share * (eye_m.head<2>() - floor_m)};
  return std::ranges::any_of(uprights.circles, [&](const Circle& circle) {
    return squared_distance(circle.centre_m, sight) <= circle.radius_m * circle.radius_m;
  });
}

}  // namespace sidestep
