// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "common/camera/camera_model.hpp"

namespace sidestep {

/// A point of the world, and the pixel where the camera sees it.
struct CalibrationPoint {
  Vec3 point_m;
  Vec2 pixel;
};

/// What is looked for, besides the pose; what is not is taken from the camera to start from.
struct CalibrationSettings {
  bool finds_focal_length = true;
  bool finds_distortion = true;
  bool finds_principal_point = false;
  double largest_top_sd_px = 0.5;  ///< of CalibrationResult::top_sd_px
};

struct CalibrationResult {
  /// Empty when the calibration is good, else why there is none; the rest is then what was found until there.
  std::string fault;
  CameraParameters camera;
  double rms_px = 0;  ///< distance between the pixels given and those of the points
  double rms_m = 0;   ///< distance between the points given and those of the pixels, at the points' heights
  /// Predicted standard deviation of the pixel where the camera sees what stands 0.15 m above one of the
  /// points, as a robot's top does; of the worst point. Points that leave the camera's height open, as a
  /// floor seen straight from above does, make it large.
  double top_sd_px = 0;
};

/// The camera that sees the points where they were seen: least squares over pixels by Levenberg and
/// Marquardt's method (Marquardt 1963) from several focal lengths. The image's size comes from `start`, and
/// what is not looked for.
CalibrationResult calibrate_camera(std::span<const CalibrationPoint> points, const CameraParameters& start,
                                   const CalibrationSettings& settings = {});

}  // namespace sidestep
