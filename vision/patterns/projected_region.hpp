// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/camera/camera_model.hpp"
#include "common/marking/colours.hpp"
#include "vision/segmentation/region.hpp"

namespace sidestep {

/// A colour region of the image, projected onto a horizontal plane.
struct ProjectedRegion {
  Colour colour{};
  Vec2 position_m{0, 0};
  double area_m2 = 0;
};

/// Pixels per square metre of a horizontal surface at a point. nullopt if the camera cannot see the point.
[[nodiscard]] std::optional<double> px2_per_m2(const CameraModel& camera, const Vec3& point_m);

/// Projects a region onto the plane at `height_m` above the floor. nullopt if the camera cannot see the plane
/// there.
[[nodiscard]] std::optional<ProjectedRegion> project_region(const Region& region, const CameraModel& camera,
                                                            double height_m);

}  // namespace sidestep
