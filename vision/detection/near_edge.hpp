// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/camera/camera_model.hpp"
#include "common/image/image.hpp"
#include "vision/detection/occlusion.hpp"

namespace sidestep {

/// The silhouette of an obstacle in polar coordinates around the point on the floor below the camera.
struct Silhouette {
  Vec2 direction{1, 0};       ///< unit vector to its middle
  double near_m = 0;          ///< distance to the nearest point that shows its colour
  double half_width_rad = 0;  ///< half the angle that it subtends
  Vec2 chroma{0, 0};          ///< its mean U and V, relative to grey
};

/// Distance to the foot of an obstacle whose side towards the camera is in shade, and so too dark for its
/// colour to be classified. Follows the hue inwards from `near_m` while there is more of it than on the floor
/// to the sides, until robots or the image border hide it. Returns `near_m` where the floor has that hue or
/// is not visible, or where the hue does not end.
[[nodiscard]] double near_edge_m(const Silhouette& silhouette, const CameraModel& camera,
                                 const ImageView& image, const VerticalCylinders& robots);

}  // namespace sidestep
