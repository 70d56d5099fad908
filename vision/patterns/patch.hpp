// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/camera/camera_model.hpp"
#include "common/marking/colours.hpp"
#include "vision/segmentation/region.hpp"

namespace sidestep {

/// A region of colour as something flat at a height over the floor.
struct Patch {
  Colour colour{};
  Vec2 position_m{0, 0};
  double area_m2 = 0;
};

/// How many square pixels a square metre at a point covers that lies flat. Nothing where the camera cannot
/// see it.
std::optional<double> px2_per_m2(const CameraModel& camera, const Vec3& point_m);

/// What a region is, taken to lie at this height. Nothing where the camera cannot see such a thing.
std::optional<Patch> patch_of(const Region& region, const CameraModel& camera, double height_m);

}  // namespace sidestep
