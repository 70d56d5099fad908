// SPDX-License-Identifier: Apache-2.0
#include "vision/calibrate/calibrate_geometry.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <unistd.h>

#include "common/file/write_file.hpp"
#include "common/process/process.hpp"
#include "common/yaml/config_error.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/camera/random_camera.hpp"
#include "tests/unit/common/random/normal_vector.hpp"
#include "tests/unit/vision/calibrate/calibrate_run.hpp"

namespace sidestep::calibrate_geometry_test {

using sidestep::test::calibrate;

/// The text of a camera's points at three heights, with noisy pixels.
std::string points_text(std::uint32_t id, const CameraModel& camera, const Box& view_m, int count,
                        double noise_px, Rng& rng) {
  const CameraParameters& p = camera.parameters();
  std::string text =
      fmt::format("  - id: {}\n    image_px: [{}, {}]\n    points:\n", id, p.width_px, p.height_px);
  for (int i = 0; i < count; ++i) {
    const Vec2 position_m = random_point_in(view_m, rng);
    const double height_m = 0.25 * (i % 3);
    const Vec2 noise = noise_px * normal_vector(rng);
    const Vec2 pixel = *camera.pixel_of({position_m.x(), position_m.y(), height_m}) + noise;
    text += fmt::format("      - {{pixel: [{}, {}], field_m: [{}, {}, {}]}}\n", pixel.x(), pixel.y(),
                        position_m.x(), position_m.y(), height_m);
  }
  return text;
}

OverheadCamera tilted_camera() {
  OverheadCamera camera;
  camera.lateral_offset_m = Vec2(0.4, -0.3);
  return camera;
}

struct Folder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("calibrate-geometry-" + std::to_string(getpid()));
  Folder() { std::filesystem::create_directories(path); }
  ~Folder() { std::filesystem::remove_all(path); }
  std::string operator/(const std::string& name) const { return (path / name).string(); }
};

TEST_CASE("known cameras are recovered from a file of points") {
  const std::uint64_t seed = 31;
  CAPTURE(seed);
  Rng rng(seed);
  const OverheadCamera overhead = tilted_camera();
  const CameraModel camera = overhead_camera_model(overhead);
  const std::string noisy = points_text(1, camera, overhead.view_m, 40, 0.2, rng);
  const std::string text = "cameras:\n" + points_text(0, camera, overhead.view_m, 40, 0, rng) + noisy;
  const auto calibrated = calibrate_geometry(parse_points(text, "points.yaml"));
  REQUIRE(calibrated.size() == 2);
  const CameraParameters& exact = calibrated[0].camera.parameters;
  CHECK(calibrated[0].camera.id == 0);
  CHECK(exact.width_px == camera.parameters().width_px);
  CHECK(exact.focal_length_px == Approx(camera.parameters().focal_length_px).epsilon(1e-5));
  CHECK(exact.distortion == Approx(camera.parameters().distortion).margin(1e-5));
  CHECK((CameraModel(exact).position_m() - camera.position_m()).norm() < 1e-4);
  CHECK(calibrated[0].result.rms_px < 1e-6);
  CHECK(calibrated[1].camera.id == 1);
  CHECK(calibrated[1].point_count == 40);
  CHECK(calibrated[1].result.rms_px > 0.2);
  CHECK(calibrated[1].result.rms_px < 0.36);
  CHECK((CameraModel(calibrated[1].camera.parameters).position_m() - camera.position_m()).norm() < 0.02);
}

TEST_CASE("the description names the point with the largest residual") {
  Rng rng(32);
  const OverheadCamera overhead = tilted_camera();
  const CameraModel camera = overhead_camera_model(overhead);
  std::string text = "cameras:\n" + points_text(4, camera, overhead.view_m, 40, 0, rng);
  const Vec2 pixel = *camera.pixel_of({0.5, 0.5, 0}) + Vec2(1.5, 0);
  text += fmt::format("      - {{pixel: [{}, {}], field_m: [0.5, 0.5]}}\n", pixel.x(), pixel.y());
  const auto calibrated = calibrate_geometry(parse_points(text, "points.yaml"));
  REQUIRE(calibrated.size() == 1);
  // Line 1 is the list's key, lines 2 to 4 are the camera's keys, and 40 points precede the wrong one.
  CHECK_THAT(describe(calibrated[0]), StartsWith("camera 4: 41 points, residual "));
  CHECK_THAT(describe(calibrated[0]), ContainsSubstring(" px at points.yaml:45, predicted error "));
}

TEST_CASE("given parameters are not estimated") {
  Rng rng(33);
  const OverheadCamera overhead;
  const CameraModel camera = overhead_camera_model(overhead);
  std::string text = "cameras:\n" + points_text(0, camera, overhead.view_m, 30, 0.1, rng);
  const std::string size = "    image_px: [780, 580]\n";
  text.replace(text.find(size), size.size(),
               size + "    focal_length_px: 590\n    distortion: 0.09\n    principal_point_px: [390, 289]\n");
  const auto cameras = parse_points(text, "points.yaml");
  REQUIRE(cameras.size() == 1);
  CHECK_FALSE(cameras[0].settings.estimates_focal_length);
  CHECK_FALSE(cameras[0].settings.estimates_distortion);
  CHECK_FALSE(cameras[0].settings.estimates_principal_point);
  const CameraParameters& initial = cameras[0].initial;
  const CameraParameters found = calibrate_camera(cameras[0].points, initial, cameras[0].settings).camera;
  CHECK(found.focal_length_px == 590);
  CHECK(found.distortion == 0.09);
  CHECK(found.principal_point_px == Vec2(390, 289));
}

TEST_CASE("the command writes a file of cameras that reads back exactly") {
  const Folder folder;
  Rng rng(34);
  const OverheadCamera overhead = tilted_camera();
  const CameraModel camera = overhead_camera_model(overhead);
  const std::string second = points_text(7, camera, overhead.view_m, 40, 0.2, rng);
  const std::string text = "cameras:\n" + points_text(0, camera, overhead.view_m, 40, 0.2, rng) + second;
  write_file(folder / "points.yaml", text);
  REQUIRE(calibrate({"--geometry", folder / "points.yaml", "--out", folder / "cameras.yaml"}) == 0);
  const auto written = load_cameras(folder / "cameras.yaml");
  const auto expected = calibrate_geometry(parse_points(text, "points.yaml"));
  REQUIRE(written.size() == 2);
  for (std::size_t i = 0; i < written.size(); ++i) {
    const CameraParameters &a = written[i].parameters, &b = expected[i].camera.parameters;
    CHECK(written[i].id == expected[i].camera.id);
    CHECK(a.focal_length_px == b.focal_length_px);
    CHECK(a.distortion == b.distortion);
    CHECK(a.principal_point_px == b.principal_point_px);
    CHECK(a.rotation.coeffs() == b.rotation.coeffs());
    CHECK(a.translation_m == b.translation_m);
  }
}

TEST_CASE(
    "points that do not determine the camera are refused with file name and line and nothing is written") {
  const Folder folder;
  Rng rng(35);
  const OverheadCamera overhead = tilted_camera();
  const CameraModel camera = overhead_camera_model(overhead);
  const std::string good = "cameras:\n" + points_text(0, camera, overhead.view_m, 40, 0, rng);
  const std::string few = good + points_text(1, camera, overhead.view_m, 4, 0, rng);
  try {
    (void)calibrate_geometry(parse_points(few, "points.yaml"));
    FAIL("accepted");
  } catch (const ConfigError& error) {
    CHECK(std::string(error.what()) == "points.yaml:45: cameras[1]: expected at least 5 points, got 4");
  }
  write_file(folder / "few.yaml", few);
  write_file(folder / "good.yaml", good);
  const std::string out = folder / "cameras.yaml";
  CHECK(calibrate({"--geometry", folder / "few.yaml", "--out", out}) == kExitUsage);
  CHECK(calibrate({"--geometry", folder / "none.yaml", "--out", out}) == kExitUsage);
  CHECK(calibrate({"--geometry", folder / "good.yaml", "--camera", "1", "--out", out}) == kExitUsage);
  CHECK(calibrate({"--geometry", folder / "good.yaml", folder / "good.yaml", "--out", out}) == kExitUsage);
  CHECK(calibrate({"--out", out}) == kExitUsage);
  CHECK_FALSE(std::filesystem::exists(out));
}

}  // namespace sidestep::calibrate_geometry_test
