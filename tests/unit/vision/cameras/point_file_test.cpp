// SPDX-License-Identifier: Apache-2.0
#include "vision/cameras/point_file.hpp"

#include "common/yaml/config_error.hpp"
#include "tests/catch.hpp"

namespace sidestep::point_file_test {

const std::string kOne = R"(cameras:
  - id: 3
    image_px: [780, 580]
    points:
      - {pixel: [35.5, 41.25], field_m: [-2.8, 2]}
      - {pixel: [401, 290], field_m: [0.1, 0, 0.15]}
)";

void check_refused(const std::string& old_text, const std::string& new_text, int line,
                   const std::string& message) {
  std::string text = kOne;
  const auto at = text.find(old_text);
  REQUIRE(at != std::string::npos);
  text.replace(at, old_text.size(), new_text);
  INFO(text);
  try {
    (void)parse_points(text, "points.yaml");
    FAIL("accepted");
  } catch (const ConfigError& error) {
    CHECK_THAT(error.what(), StartsWith("points.yaml:" + std::to_string(line) + ": "));
    CHECK_THAT(error.what(), ContainsSubstring(message));
  }
}

TEST_CASE("a file of calibration points is read") {
  const auto cameras = parse_points(kOne, "points.yaml");
  REQUIRE(cameras.size() == 1);
  const CameraPoints& camera = cameras[0];
  CHECK(camera.id == 3);
  CHECK(camera.location.line == 2);
  CHECK(camera.initial.width_px == 780);
  CHECK(camera.initial.height_px == 580);
  CHECK(camera.initial.principal_point_px == Vec2(389.5, 289.5));
  CHECK(camera.settings.estimates_focal_length);
  CHECK(camera.settings.estimates_distortion);
  CHECK_FALSE(camera.settings.estimates_principal_point);
  REQUIRE(camera.points.size() == 2);
  CHECK(camera.points[0].pixel == Vec2(35.5, 41.25));
  CHECK(camera.points[0].point_m == Vec3(-2.8, 2, 0));
  CHECK(camera.points[1].point_m == Vec3(0.1, 0, 0.15));
  CHECK(camera.point_locations[1].line == 6);
}

TEST_CASE("known parameters are taken from the file and the principal point is estimated on request") {
  std::string text = kOne;
  const std::string size = "image_px: [780, 580]\n";
  text.replace(text.find(size), size.size(),
               size + "    focal_length_px: 500\n    distortion: 0.05\n    estimate_principal_point: true\n");
  const CameraPoints camera = parse_points(text, "points.yaml").front();
  CHECK(camera.initial.focal_length_px == 500);
  CHECK(camera.initial.distortion == 0.05);
  CHECK_FALSE(camera.settings.estimates_focal_length);
  CHECK_FALSE(camera.settings.estimates_distortion);
  CHECK(camera.settings.estimates_principal_point);
}

TEST_CASE("invalid files of calibration points are refused with file name and line") {
  check_refused("id: 3", "id: 1024", 2, "expected 0 to 1023");
  check_refused("[780, 580]", "[780]", 3, "expected a list of 2 numbers");
  check_refused("    image_px: [780, 580]\n", "", 2, "\"image_px\" is missing");
  check_refused("[35.5, 41.25]", "[35.5, left]", 5, "cameras[0].points[0].pixel");
  check_refused("[35.5, 41.25]", "[35.5, .nan]", 5, "expected a number");
  check_refused("pixel: [35.5, 41.25], ", "", 5, "\"pixel\" is missing");
  check_refused("[-2.8, 2]", "[-2.8]", 5, "field_m");
  check_refused("[0.1, 0, 0.15]", "[0.1, 0, 0.15, 1]", 6, "field_m");
  check_refused("[0.1, 0, 0.15]", "[0.1, 2000]", 6, "field_m");
  check_refused("field_m: [0.1", "world_m: [0.1", 6, "field_m");
  check_refused("    points:", "    focal_length_px: 0\n    points:", 4, "focal_length_px");
  check_refused("    points:", "    zoom: 2\n    points:", 4, "unknown key \"zoom\"");
  const std::string twice = kOne + kOne.substr(kOne.find('\n') + 1);
  CHECK_THROWS_WITH(parse_points(twice, "points.yaml"), ContainsSubstring("another camera has the id 3"));
  CHECK_THROWS_AS(parse_points("cameras: []", "points.yaml"), ConfigError);
  CHECK_THROWS_AS(load_points("/nowhere/points.yaml"), ConfigError);
}

}  // namespace sidestep::point_file_test
