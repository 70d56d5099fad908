// SPDX-License-Identifier: Apache-2.0
#include "vision/cameras/camera_file.hpp"

#include <fmt/format.h>

#include "common/yaml/yaml_document.hpp"
#include "common/yaml/yaml_map.hpp"
#include "vision/cameras/camera_keys.hpp"

namespace sidestep {
namespace {

constexpr const char* kExpected = "a file of cameras";

std::vector<double> required_numbers(YamlMap& map, const std::string& key, std::size_t count, Range range) {
  return numbers_from(map.require(key), map.location_of(key), count, count, range);
}

NumberedCamera read_camera(YamlMap& map) {
  NumberedCamera result;
  CameraParameters& camera = result.parameters;
  result.id = camera_keys::read_id(map);
  camera_keys::read_image_size(map, camera);
  map.require("focal_length_px");
  map.read("focal_length_px", camera_keys::kFocalLength_px, camera.focal_length_px);
  map.require("principal_point_px");
  map.read("principal_point_px", camera_keys::kPixel, camera.principal_point_px);
  map.require("distortion");
  map.read("distortion", camera_keys::kDistortion, camera.distortion);
  const auto q = required_numbers(map, "rotation_xyzw", 4, {-1, 1});
  camera.rotation = Eigen::Quaterniond(q[3], q[0], q[1], q[2]);
  const auto t = required_numbers(map, "translation_m", 3, camera_keys::kCoordinate_m);
  camera.translation_m = Vec3(t[0], t[1], t[2]);
  if (const std::string error = validation_error(camera); !error.empty())
    map.location_of("rotation_xyzw").fail(error);
  return result;
}

}  // namespace

std::vector<NumberedCamera> parse_cameras(const std::string& text, const std::string& file_name) {
  return camera_keys::read_cameras<NumberedCamera>(document_map(text, file_name, kExpected), read_camera);
}

std::vector<NumberedCamera> load_cameras(const std::string& path) {
  return parse_cameras(read_yaml_file(path, kExpected), path);
}

std::string cameras_text(const std::vector<NumberedCamera>& cameras) {
  std::string text = "cameras:\n";
  for (const NumberedCamera& camera : cameras) {
    const CameraParameters& p = camera.parameters;
    const Eigen::Quaterniond& q = p.rotation;
    text += fmt::format(
        "  - id: {}\n    image_px: [{}, {}]\n    focal_length_px: {}\n    principal_point_px: [{}, {}]\n"
        "    distortion: {}\n    rotation_xyzw: [{}, {}, {}, {}]\n    translation_m: [{}, {}, {}]\n",
        camera.id, p.width_px, p.height_px, p.focal_length_px, p.principal_point_px.x(),
        p.principal_point_px.y(), p.distortion, q.x(), q.y(), q.z(), q.w(), p.translation_m.x(),
        p.translation_m.y(), p.translation_m.z());
  }
  return text;
}

}  // namespace sidestep
