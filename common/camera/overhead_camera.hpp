// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/camera/camera_model.hpp"
#include "common/geometry/box.hpp"

namespace sidestep {

/// A camera mounted above the floor that covers a rectangle of it.
struct OverheadCamera {
  Box view_m{{-3, -2.25}, {3, 2.25}};  ///< the rectangle on the floor
  double object_height_m = 0.15;       ///< objects in the rectangle are in view up to this height
  double height_m = 4;                 ///< height of the camera above the floor
  Vec2 lateral_offset_m{0, 0};         ///< offset of the camera from the rectangle's centre; tilts the camera
  int width_px = 780;
  int height_px = 580;
  double distortion = 0.1;  ///< coefficient k in common/camera/lens.hpp
};

/// The model of a camera that points at the rectangle's centre, with the principal point in the middle of the
/// image, the longer side of the rectangle along the longer side of the image, and the maximum focal length
/// that keeps the whole rectangle in view. Throws std::invalid_argument if there is no such camera: an empty
/// rectangle, a camera that is too low, or a distortion whose domain is too small.
CameraModel overhead_camera_model(const OverheadCamera& camera);

}  // namespace sidestep
