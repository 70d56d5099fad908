// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/camera/camera_model.hpp"
#include "common/geometry/box.hpp"

namespace sidestep {

/// A camera that hangs somewhere over the floor and is to see a rectangle of it.
struct OverheadCamera {
  Box view_m{{-3, -2.25}, {3, 2.25}};  ///< of the floor
  double top_m = 0.15;                 ///< what stands in the rectangle is seen up to this height
  double height_m = 4;                 ///< of the camera
  Vec2 aside_m{0, 0};                  ///< of the rectangle's centre; it tilts the camera
  int width_px = 780;
  int height_px = 580;
  double distortion = 0.1;  ///< k of common/camera/lens.hpp
};

/// The camera that looks at the rectangle's centre, with the longest focal length that leaves the whole
/// rectangle in the image, the principal point in its middle, and the rectangle's longer side along the
/// image's longer one. Throws std::invalid_argument when there is no such camera: no rectangle, too low, or a
/// distortion whose domain is too small.
CameraModel hang(const OverheadCamera& camera);

}  // namespace sidestep
