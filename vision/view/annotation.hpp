// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "common/camera/camera_model.hpp"
#include "common/config/scenario.hpp"
#include "idl/vision.hpp"

namespace sidestep {

/// Line colour as blue, green and red.
using Ink = cv::Scalar;

/// Draws horizontal shapes at a given height above the floor into a camera's picture. Shapes that the camera
/// cannot see are omitted.
class FloorPen {
 public:
  FloorPen(cv::Mat3b& picture, const CameraModel& camera) : picture_(picture), camera_(camera) {}

  void circle(const Vec2& centre_m, double height_m, double radius_m, const Ink& ink);
  void cross(const Vec2& centre_m, double height_m, double radius_m, const Ink& ink);
  void line(const Vec2& from_m, const Vec2& to_m, double height_m, const Ink& ink);
  void text(const std::string& text, const Vec2& position_m, double height_m, const Ink& ink);

 private:
  std::optional<cv::Point> pixel_of(const Vec2& position_m, double height_m) const;

  cv::Mat3b& picture_;
  const CameraModel& camera_;
};

/// Draws detections: robots with their numbers in their team's colour, balls, obstacles.
void draw_detections(const msg::DetectionFrame& frame, const Scenario& scenario, FloorPen& pen);

}  // namespace sidestep
