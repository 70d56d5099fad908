// SPDX-License-Identifier: Apache-2.0
#include "vision/cameras/camera_file.hpp"

#include <filesystem>
#include <unistd.h>

#include "common/file/write_file.hpp"
#include "common/yaml/config_error.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/camera/random_camera.hpp"

namespace sidestep::camera_file_test {

const std::string kOne = R"(cameras:
  - id: 3
    image_px: [780, 580]
    focal_length_px: 512.25
    principal_point_px: [389.5, 289.5]
    distortion: 0.1
    rotation_xyzw: [1, 0, 0, 0]
    translation_m: [0, 0.5, 4]
)";

void check_refused(const std::string& old_text, const std::string& new_text, int line,
                   const std::string& message) {
  std::string text = kOne;
  const auto at = text.find(old_text);
  REQUIRE(at != std::string::npos);
  text.replace(at, old_text.size(), new_text);
  INFO(text);
  try {
    (void)parse_cameras(text, "cameras.yaml");
    FAIL("accepted");
  } catch (const ConfigError& error) {
    INFO(error.what());
    const std::string beginning = "cameras.yaml:" + std::to_string(line) + ": ";
    CHECK(std::string(error.what()).rfind(beginning, 0) == 0);
    CHECK(std::string(error.what()).find(message) != std::string::npos);
  }
}

bool are_equal(const CameraParameters& a, const CameraParameters& b) {
  return a.width_px == b.width_px && a.height_px == b.height_px && a.focal_length_px == b.focal_length_px &&
         a.principal_point_px == b.principal_point_px && a.distortion == b.distortion &&
         a.rotation.coeffs() == b.rotation.coeffs() && a.translation_m == b.translation_m;
}

TEST_CASE("a camera file is read") {
  const auto cameras = parse_cameras(kOne, "cameras.yaml");
  REQUIRE(cameras.size() == 1);
  CHECK(cameras[0].id == 3);
  CameraParameters expected;
  expected.focal_length_px = 512.25;
  expected.distortion = 0.1;
  expected.translation_m = Vec3(0, 0.5, 4);
  CHECK(are_equal(cameras[0].parameters, expected));
}

TEST_CASE("cameras are restored bit for bit from a file") {
  const std::uint64_t seed = 8;
  CAPTURE(seed);
  Rng rng(seed);
  std::vector<NumberedCamera> cameras;
  for (std::uint32_t id = 0; id < 20; ++id)
    cameras.push_back({id, overhead_camera_model(random_overhead_camera(rng)).parameters()});
  const std::string path =
      (std::filesystem::temp_directory_path() / ("cameras-" + std::to_string(getpid()) + ".yaml")).string();
  write_file(path, cameras_text(cameras));
  const auto loaded = load_cameras(path);
  std::filesystem::remove(path);
  REQUIRE(loaded.size() == cameras.size());
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    CHECK(loaded[i].id == cameras[i].id);
    CHECK(are_equal(loaded[i].parameters, cameras[i].parameters));
  }
}

TEST_CASE("invalid camera files are refused with file name and line") {
  check_refused("id: 3", "id: -1", 2, "expected 0 to 1023");
  check_refused("[780, 580]", "[780]", 3, "expected a list of 2 numbers");
  check_refused("[780, 580]", "[780.5, 580]", 3, "whole number");
  check_refused("[780, 580]", "[780, 0]", 3, "expected 1 to 16384");
  check_refused("512.25", "-5", 4, "cameras[0].focal_length_px");
  check_refused("512.25", "far", 4, "expected a number");
  check_refused("    focal_length_px: 512.25\n", "", 2, "\"focal_length_px\" is missing");
  check_refused("    translation_m: [0, 0.5, 4]\n", "", 2, "\"translation_m\" is missing");
  check_refused("[0, 0.5, 4]", "[0, .inf, 4]", 8, "expected a number");
  check_refused("[1, 0, 0, 0]", "[1, 1, 0, 0]", 7, "unit quaternion");
  check_refused("[1, 0, 0, 0]", "[1, 0, 0]", 7, "expected a list of 4 numbers");
  check_refused("distortion:", "distorsion:", 2, "is missing");
  check_refused("    distortion: 0.1\n", "    distortion: 0.1\n    zoom: 2\n", 7, "unknown key \"zoom\"");
  check_refused("cameras:", "camera:", 1, "\"cameras\" is missing");
  std::string twice = kOne + kOne.substr(kOne.find('\n') + 1);
  CHECK_THROWS_AS(parse_cameras(twice, "cameras.yaml"), ConfigError);
  CHECK_THROWS_AS(parse_cameras("cameras: []", "cameras.yaml"), ConfigError);
  CHECK_THROWS_AS(load_cameras("/nowhere/cameras.yaml"), ConfigError);
}

}  // namespace sidestep::camera_file_test
