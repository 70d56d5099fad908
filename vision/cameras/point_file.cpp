// SPDX-License-Identifier: Apache-2.0
#include "vision/cameras/point_file.hpp"

#include "common/yaml/yaml_document.hpp"
#include "vision/cameras/camera_keys.hpp"

namespace sidestep {
namespace {

constexpr const char* kExpected = "a file of calibration points";
constexpr std::size_t kMaxPoints = 10000;

CalibrationPoint read_point(YamlMap& map) {
  const auto pixel = numbers_from(map.require("pixel"), map.location_of("pixel"), 2, 2, camera_keys::kPixel);
  const auto field_m =
      numbers_from(map.require("field_m"), map.location_of("field_m"), 2, 3, camera_keys::kCoordinate_m);
  return {Vec3(field_m[0], field_m[1], field_m.size() > 2 ? field_m[2] : 0), Vec2(pixel[0], pixel[1])};
}

CameraPoints read_camera(YamlMap& map) {
  CameraPoints camera;
  camera.location = map.location();
  camera.id = camera_keys::read_id(map);
  camera_keys::read_image_size(map, camera.initial);
  camera.settings.estimates_focal_length = !map.find("focal_length_px").IsDefined();
  map.read("focal_length_px", camera_keys::kFocalLength_px, camera.initial.focal_length_px);
  camera.settings.estimates_distortion = !map.find("distortion").IsDefined();
  map.read("distortion", camera_keys::kDistortion, camera.initial.distortion);
  camera.initial.principal_point_px = Vec2(camera.initial.width_px - 1, camera.initial.height_px - 1) / 2;
  map.read("principal_point_px", camera_keys::kPixel, camera.initial.principal_point_px);
  map.read("estimate_principal_point", camera.settings.estimates_principal_point);
  read_list(map, "points", kMaxPoints, [&](YamlMap& point) {
    camera.points.push_back(read_point(point));
    camera.point_locations.push_back(point.location());
  });
  return camera;
}

}  // namespace

std::vector<CameraPoints> parse_points(const std::string& text, const std::string& file_name) {
  return camera_keys::read_cameras<CameraPoints>(document_map(text, file_name, kExpected), read_camera);
}

std::vector<CameraPoints> load_points(const std::string& path) {
  return parse_points(read_yaml_file(path, kExpected), path);
}

}  // namespace sidestep
