// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/yaml/yaml_map.hpp"
#include "vision/cameras/camera_calibration.hpp"

namespace sidestep {

/// The input for the calibration of one camera.
struct CameraPoints {
  std::uint32_t id = 0;
  CameraParameters initial;      ///< image size, and the known parameters
  CalibrationSettings settings;  ///< which parameters to estimate
  std::vector<CalibrationPoint> points;
  std::vector<YamlLocation> point_locations;  ///< locations of `points`
  YamlLocation location;
};

/// Reads and validates a file of calibration points; throws ConfigError ("FILE:LINE: ...") for any error.
/// Each point has its pixel and its position on the field, with its height above the floor unless that is 0.
/// The focal length and the distortion are estimated unless the file gives them. The principal point is the
/// image centre unless it is given; it is estimated only on request.
/// ```
/// cameras:
///   - id: 0
///     image_px: [780, 580]
///     focal_length_px: 512.25                # optional
///     distortion: 0.1                        # optional
///     principal_point_px: [389.5, 289.5]     # optional
///     estimate_principal_point: false        # optional
///     points:
///       - {pixel: [35.2, 41.9], field_m: [-2.8, 2]}
///       - {pixel: [401.7, 290.3], field_m: [0.1, 0, 0.15]}
/// ```
[[nodiscard]] std::vector<CameraPoints> load_points(const std::string& path);
/// Parses and checks the text of a file of calibration points; `file_name` appears in error messages.
[[nodiscard]] std::vector<CameraPoints> parse_points(const std::string& text, const std::string& file_name);

}  // namespace sidestep
