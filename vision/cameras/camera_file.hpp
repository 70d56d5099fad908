// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/camera/camera_model.hpp"

namespace sidestep {

/// A camera and its number in messages.
struct NumberedCamera {
  std::uint32_t id = 0;
  CameraParameters parameters;
};

/// Reads and validates a file of cameras; throws ConfigError ("FILE:LINE: ...") for any error.
/// ```
/// cameras:
///   - id: 0
///     image_px: [780, 580]
///     focal_length_px: 512.25
///     principal_point_px: [389.5, 289.5]
///     distortion: 0.1
///     rotation_xyzw: [1, 0, 0, 0]
///     translation_m: [0, 0, 4]
/// ```
[[nodiscard]] std::vector<NumberedCamera> load_cameras(const std::string& path);
/// Parses and checks the text of a file of cameras; `file_name` appears in error messages.
[[nodiscard]] std::vector<NumberedCamera> parse_cameras(const std::string& text,
                                                        const std::string& file_name);
/// The text of a file from which parse_cameras() restores every number exactly.
[[nodiscard]] std::string cameras_text(const std::vector<NumberedCamera>& cameras);

}  // namespace sidestep
