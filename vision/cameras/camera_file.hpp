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

/// Reads and checks a file of cameras; throws ScenarioError ("FILE:LINE: ...") for anything that is wrong.
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
std::vector<NumberedCamera> load_cameras(const std::string& path);
/// The same from text; `file_name` stands in messages.
std::vector<NumberedCamera> parse_cameras(const std::string& text, const std::string& file_name);
/// What parse_cameras() reads back to the last bit.
std::string cameras_text(const std::vector<NumberedCamera>& cameras);
/// Throws std::runtime_error when the file cannot be written.
void save_cameras(const std::vector<NumberedCamera>& cameras, const std::string& path);

}  // namespace sidestep
