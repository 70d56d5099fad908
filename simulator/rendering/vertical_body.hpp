// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/camera/camera_model.hpp"
#include "simulator/rendering/canvas.hpp"

namespace sidestep {

/// A dot on a body's top.
struct TopDot {
  Vec2 position_m;  ///< in the body's frame
  double radius_m;
  Light light;
};

/// An upright cylinder on the floor, maybe with a flat front, and dots on its top.
struct VerticalBody {
  Vec2 position_m;
  double heading_rad = 0;
  double radius_m = 0.09;
  double front_m = 1e3;  ///< of the flat front from the centre; beyond radius_m there is none
  double height_m = 0.15;
  Light top, side;
  std::span<const TopDot> dots;  ///< they do not overlap, and lie within the top
  Vec2 velocity_mps{0, 0};
  double angular_radps = 0;
};

/// Draws what the camera sees of a body over what is there, edges by the share of each pixel that they cover,
/// moving bodies by their share of the exposure. Returns the pixels that may have changed; none when the body
/// is outside the image, or not all of it is before the camera.
cv::Rect draw(const VerticalBody& body, const CameraModel& camera, double exposure_s, Canvas& canvas);

}  // namespace sidestep
