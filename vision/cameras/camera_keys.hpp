// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "common/camera/camera_model.hpp"
#include "common/yaml/yaml_map.hpp"

/// Keys and ranges shared by files of cameras and files of calibration points.
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
/// Throws a ConfigError if `ids` contains `id`; otherwise adds it. `map` is the camera's mapping.
void require_new_id(YamlMap& map, std::uint32_t id, std::set<std::uint32_t>& ids);

/// The cameras in a file whose only key is `cameras`. `read_camera` reads one camera from a YamlMap&.
template <typename Camera, typename Read>
[[nodiscard]] std::vector<Camera> read_cameras(YamlMap file, Read read_camera) {
  std::vector<Camera> cameras;
  std::set<std::uint32_t> ids;
  read_list(file, "cameras", kMaxCameras, [&](YamlMap& map) {
    cameras.push_back(read_camera(map));
    require_new_id(map, cameras.back().id, ids);
  });
  file.finish();
  return cameras;
}

}  // namespace sidestep::camera_keys
