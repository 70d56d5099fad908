// SPDX-License-Identifier: Apache-2.0
#include "vision/cameras/camera_keys.hpp"

#include <fmt/format.h>

namespace sidestep::camera_keys {

std::uint32_t read_id(YamlMap& map) {
  return static_cast<std::uint32_t>(integer_from(map.require("id"), map.location_of("id"), {0, 1023}));
}

void read_image_size(YamlMap& map, CameraParameters& camera) {
  constexpr Range kSize_px{1, 16384};
  const YAML::Node size = map.require("image_px");
  const YamlLocation location = map.location_of("image_px");
  numbers_from(size, location, 2, 2, kSize_px);
  const auto pixels = [&](std::size_t i) {
    return static_cast<int>(integer_from(size[i], location.of(size[i], location.what), kSize_px));
  };
  camera.width_px = pixels(0);
  camera.height_px = pixels(1);
}

void require_new_id(YamlMap& map, std::uint32_t id, std::set<std::uint32_t>& ids) {
  if (!ids.insert(id).second) map.location_of("id").fail(fmt::format("another camera has the id {}", id));
}

}  // namespace sidestep::camera_keys
