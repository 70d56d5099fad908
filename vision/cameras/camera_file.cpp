// SPDX-License-Identifier: Apache-2.0
#include "vision/cameras/camera_file.hpp"

#include <fmt/format.h>
#include <fstream>
#include <set>
#include <stdexcept>

#include "common/config/yaml_document.hpp"
#include "common/config/yaml_map.hpp"

namespace sidestep {
namespace {

constexpr const char* kExpected = "a file of cameras";
constexpr std::size_t kMaxCameras = 64;
constexpr Range kSize_px{1, 16384};
constexpr Range kPixel{-1e5, 1e5};
constexpr Range kPlace_m{-1000, 1000};

std::vector<double> required_numbers(YamlMap& map, const std::string& key, std::size_t count, Range range) {
  return numbers_from(map.require(key), map.place_of(key), count, count, range);
}

NumberedCamera read_camera(YamlMap& map) {
  NumberedCamera result;
  CameraParameters& camera = result.parameters;
  result.id = static_cast<std::uint32_t>(integer_from(map.require("id"), map.place_of("id"), {0, 1023}));
  const YAML::Node size = map.require("image_px");
  const YamlPlace size_place = map.place_of("image_px");
  numbers_from(size, size_place, 2, 2, kSize_px);
  camera.width_px =
      static_cast<int>(integer_from(size[0], size_place.of(size[0], size_place.what), kSize_px));
  camera.height_px =
      static_cast<int>(integer_from(size[1], size_place.of(size[1], size_place.what), kSize_px));
  map.require("focal_length_px");
  map.read("focal_length_px", {1e-3, 1e6}, camera.focal_length_px);
  map.require("principal_point_px");
  map.read("principal_point_px", kPixel, camera.principal_point_px);
  map.require("distortion");
  map.read("distortion", {-100, 100}, camera.distortion);
  const auto q = required_numbers(map, "rotation_xyzw", 4, {-1, 1});
  camera.rotation = Eigen::Quaterniond(q[3], q[0], q[1], q[2]);
  const auto t = required_numbers(map, "translation_m", 3, kPlace_m);
  camera.translation_m = Vec3(t[0], t[1], t[2]);
  if (const std::string fault = fault_of(camera); !fault.empty()) map.place_of("rotation_xyzw").refuse(fault);
  return result;
}

}  // namespace

std::vector<NumberedCamera> parse_cameras(const std::string& text, const std::string& file_name) {
  YamlMap map = document_map(text, file_name, kExpected);
  std::vector<NumberedCamera> cameras;
  std::set<std::uint32_t> ids;
  read_list(map, "cameras", kMaxCameras, [&](YamlMap& inner) {
    cameras.push_back(read_camera(inner));
    if (!ids.insert(cameras.back().id).second)
      inner.place_of("id").refuse(fmt::format("another camera has the id {}", cameras.back().id));
  });
  map.finish();
  return cameras;
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

void save_cameras(const std::vector<NumberedCamera>& cameras, const std::string& path) {
  std::ofstream file(path);
  file << cameras_text(cameras);
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path);
}

}  // namespace sidestep
