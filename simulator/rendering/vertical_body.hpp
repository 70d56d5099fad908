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

/// A vertical cylinder on the floor, optionally with a flat front, with dots on its top.
struct VerticalBody {
  Vec2 position_m;
  double heading_rad = 0;
  double radius_m = 0.09;
  double front_m = 1e3;  ///< distance of the flat front from the centre; no front if it exceeds radius_m
  double height_m = 0.15;
  Light top, side;
  std::span<const TopDot> dots;  ///< must not overlap, and must lie within the top
  Vec2 velocity_mps{0, 0};
  double angular_radps = 0;
};

/// Draws a camera's view of a body over the canvas, antialiased at edges and blurred by motion during the
/// exposure. Returns the pixels that may have changed; empty if the body is outside the image or not entirely
/// in front of the camera.
cv::Rect draw(const VerticalBody& body, const CameraModel& camera, double exposure_s, Canvas& canvas);

}  // namespace sidestep
