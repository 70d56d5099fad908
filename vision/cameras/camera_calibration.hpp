// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "common/camera/camera_model.hpp"

namespace sidestep {

/// A point in the world, and the pixel at which the camera observes it.
struct CalibrationPoint {
  Vec3 point_m;
  Vec2 pixel;
};

/// Parameters to estimate in addition to the camera's pose. The others keep their initial values.
struct CalibrationSettings {
  bool estimates_focal_length = true;
  bool estimates_distortion = true;
  bool estimates_principal_point = false;
};

struct CalibrationResult {
  /// Why the calibration failed; empty on success. After a failure the other members are incomplete.
  std::string error;
  CameraParameters camera;
  double rms_px = 0;            ///< RMS distance between given pixels and projected points
  double max_px = 0;            ///< maximum of these distances
  std::size_t worst_index = 0;  ///< index of the point with the maximum distance
  double rms_m = 0;             ///< RMS distance between given points and pixels projected to their heights
  /// Predicted standard deviation of the pixel at which the camera observes the top of a robot, 0.15 m above
  /// one of the points; the maximum over all points. Large if the points do not determine the camera's
  /// height, such as points on the floor seen vertically from above.
  double robot_top_sd_px = 0;
};

/// The camera that best explains the observed pixels: least squares over pixel errors by the
/// Levenberg-Marquardt method (Marquardt 1963), from several initial focal lengths. `initial` provides the
/// image size and all parameters that are not estimated.
[[nodiscard]] CalibrationResult calibrate_camera(std::span<const CalibrationPoint> points,
                                                 const CameraParameters& initial,
                                                 const CalibrationSettings& settings = {});

}  // namespace sidestep
