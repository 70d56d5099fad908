// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "vision/cameras/camera_file.hpp"
#include "vision/cameras/point_file.hpp"

namespace sidestep {

/// A calibrated camera, and how well it fits its points.
struct CalibratedCamera {
  NumberedCamera camera;
  std::size_t point_count = 0;
  CalibrationResult result;
  YamlLocation worst_point;  ///< location of the point with the largest residual
};

/// Calibrates each camera from its points. Throws ConfigError ("FILE:LINE: cameras[i]: ...") if a camera's
/// points do not determine it.
[[nodiscard]] std::vector<CalibratedCamera> calibrate_geometry(const std::vector<CameraPoints>& cameras);

/// One line per camera: number of points, residuals, and the predicted error at the height of robots.
[[nodiscard]] std::string describe(const CalibratedCamera& camera);

}  // namespace sidestep
