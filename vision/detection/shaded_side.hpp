// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/camera/camera_model.hpp"
#include "common/image/image.hpp"
#include "vision/detection/vertical.hpp"

namespace sidestep {

/// Something that was seen, from the place below the camera.
struct SeenThing {
  Vec2 ahead{1, 0};     ///< unit vector to its middle
  double near_m = 0;    ///< to the nearest point that shows its colour
  double half_rad = 0;  ///< half the angle that it is wide
  Vec2 colour{0, 0};    ///< its mean U and V, less grey's
};

/// How near a thing comes whose upright side is in the shade, and so too dark for its colour to be told from
/// the ground's: as far as there is more of its hue than beside it, up to where robots or the image's edge
/// hide it. near_m where the ground has that hue or is not in view, or where the hue does not end.
double near_with_shade_m(const SeenThing& thing, const CameraModel& camera, const ImageView& image,
                         const Uprights& robots);

}  // namespace sidestep
