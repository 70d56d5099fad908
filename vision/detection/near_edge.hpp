// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/camera/camera_model.hpp"
#include "common/image/image.hpp"
#include "vision/detection/occlusion.hpp"

namespace sidestep {

/// The silhouette of an obstacle in polar coordinates around the floor point below the camera.
struct Silhouette {
  Vec2 direction{1, 0};       ///< unit vector to the middle of the silhouette
  double near_m = 0;          ///< distance to the nearest point with the obstacle's colour
  double half_width_rad = 0;  ///< half the angle that the obstacle subtends
  Vec2 chroma{0, 0};          ///< mean U and V of the obstacle, relative to grey
};

/// Distance to the foot of an obstacle whose side towards the camera is in shade and therefore too dark for
/// its colour to be classified. Follows the hue inwards from `near_m` while it is stronger than on the floor
/// to the sides, until robots or the image border hide it. Returns `near_m` if the floor has the obstacle's
/// hue or is not visible, or if the hue does not end.
[[nodiscard]] double near_edge_m(const Silhouette& silhouette, const CameraModel& camera,
                                 const ImageView& image, const VerticalCylinders& robots);

}  // namespace sidestep
