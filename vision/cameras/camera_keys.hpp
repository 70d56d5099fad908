// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/camera/camera_model.hpp"
#include "common/config/yaml_map.hpp"

/// Keys and ranges that files of cameras and files of calibration points have in common.
namespace sidestep::camera_keys {

inline constexpr std::size_t kMaxCameras = 64;
inline constexpr Range kFocalLength_px{1e-3, 1e6};
inline constexpr Range kDistortion{-100, 100};
inline constexpr Range kPixel{-1e5, 1e5};
inline constexpr Range kCoordinate_m{-1000, 1000};

/// The camera's number in messages, under the key `id`.
[[nodiscard]] std::uint32_t read_id(YamlMap& map);
/// Sets width and height from the key `image_px`.
void read_image_size(YamlMap& map, CameraParameters& camera);

}  // namespace sidestep::camera_keys
