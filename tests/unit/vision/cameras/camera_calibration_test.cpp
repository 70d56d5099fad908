// SPDX-License-Identifier: Apache-2.0
#include "vision/cameras/camera_calibration.hpp"

#include <vector>

#include "tests/catch.hpp"
#include "tests/unit/common/camera/random_camera.hpp"
#include "tests/unit/common/random/normal_vector.hpp"

namespace sidestep::camera_calibration_test {

/// Random points at each of the given heights in turn, with noisy pixels.
std::vector<CalibrationPoint> noisy_points(const CameraModel& camera, const Box& view_m, int count,
                                           const std::vector<double>& heights_m, double noise_px, Rng& rng) {
  std::vector<CalibrationPoint> points;
  for (int i = 0; i < count; ++i) {
    const Vec2 p = random_point_in(view_m, rng);
    const Vec3 point(p.x(), p.y(), heights_m[static_cast<std::size_t>(i) % heights_m.size()]);
    points.push_back({point, *camera.pixel_of(point) + noise_px * normal_vector(rng)});
  }
  return points;
}

/// Initial parameters for a user who knows only the image size.
CameraParameters initial_of(const CameraModel& camera) {
  CameraParameters initial;
  initial.width_px = camera.parameters().width_px;
  initial.height_px = camera.parameters().height_px;
  initial.principal_point_px = Vec2(initial.width_px - 1, initial.height_px - 1) / 2;
  return initial;
}

TEST_CASE("a camera is recovered from points without noise") {
  const std::uint64_t seed = 9;
  CAPTURE(seed);
  Rng rng(seed);
  int determined = 0;
  for (int i = 0; i < 60; ++i) {
    CAPTURE(i);
    const OverheadCamera overhead_camera = random_overhead_camera(rng);
    const CameraModel camera = overhead_camera_model(overhead_camera);
    const auto points = noisy_points(camera, overhead_camera.view_m, 30, {0, 0.15, 0.5}, 0, rng);
    const CalibrationResult found = calibrate_camera(points, initial_of(camera));
    CAPTURE(found.error, found.rms_px, found.robot_top_sd_px, overhead_camera.distortion);
    // In a narrow view from high up, focal length and height can hardly be told apart.
    if (!found.error.empty() && found.robot_top_sd_px > 0.5) continue;
    REQUIRE(found.error.empty());
    const CameraParameters& truth = camera.parameters();
    ++determined;
    CHECK(found.rms_px < 1e-6);
    CHECK(found.rms_m < 1e-8);
    CHECK(found.camera.focal_length_px == Approx(truth.focal_length_px).epsilon(1e-5));
    CHECK(found.camera.distortion == Approx(truth.distortion).margin(1e-5));
    CHECK((CameraModel(found.camera).position_m() - camera.position_m()).norm() < 1e-4);
    CHECK(std::abs(found.camera.rotation.dot(truth.rotation)) == Approx(1).epsilon(1e-9));
  }
  CHECK(determined >= 55);
}

TEST_CASE("noisy points give an accurate camera on the floor and at the height of robots") {
  const std::uint64_t seed = 10;
  CAPTURE(seed);
  Rng rng(seed);
  OverheadCamera overhead_camera;
  overhead_camera.lateral_offset_m = Vec2(0.4, -0.3);
  const CameraModel camera = overhead_camera_model(overhead_camera);
  CalibrationSettings settings;
  settings.estimates_principal_point = GENERATE(false, true);
  CAPTURE(settings.estimates_principal_point);
  double sum = 0;
  int count = 0;
  for (int trial = 0; trial < 10; ++trial) {
    const auto points = noisy_points(camera, overhead_camera.view_m, 60, {0, 0.15, 0.6}, 0.2, rng);
    const CalibrationResult found = calibrate_camera(points, initial_of(camera), settings);
    CAPTURE(found.error);
    REQUIRE(found.error.empty());
    // The noise is 0.2 pixels on each of two axes.
    CHECK(found.rms_px > 0.2);
    CHECK(found.rms_px < 0.36);
    CHECK(found.max_px > found.rms_px);
    const CalibrationPoint& worst = points[found.worst_index];
    CHECK((*CameraModel(found.camera).pixel_of(worst.point_m) - worst.pixel).norm() == found.max_px);
    CHECK(found.rms_m > 0.001);
    CHECK(found.rms_m < 0.004);
    const CameraModel model(found.camera);
    for (int i = 0; i < 200; ++i) {
      const Vec2 p = random_point_in(overhead_camera.view_m, rng);
      const Vec3 point(p.x(), p.y(), i % 2 == 0 ? 0 : 0.15);
      const double error_px = (*model.pixel_of(point) - *camera.pixel_of(point)).norm();
      CHECK(error_px < 5 * found.robot_top_sd_px);
      sum += error_px * error_px;
      ++count;
    }
  }
  CHECK(std::sqrt(sum / count) < 0.15);
}

TEST_CASE("parameters that are not estimated keep their values") {
  const std::uint64_t seed = 11;
  CAPTURE(seed);
  Rng rng(seed);
  OverheadCamera overhead_camera;
  const CameraModel camera = overhead_camera_model(overhead_camera);  // a vertical view
  const auto points = noisy_points(camera, overhead_camera.view_m, 40, {0}, 0.1, rng);
  CameraParameters initial = camera.parameters();
  initial.rotation = Eigen::Quaterniond::Identity();
  initial.translation_m.setZero();
  CalibrationSettings settings;
  settings.estimates_focal_length = false;
  const CalibrationResult found = calibrate_camera(points, initial, settings);
  CAPTURE(found.error);
  REQUIRE(found.error.empty());
  CHECK(found.camera.focal_length_px == initial.focal_length_px);
  CHECK(found.camera.principal_point_px == initial.principal_point_px);
  CHECK(found.camera.distortion != initial.distortion);
  CHECK((CameraModel(found.camera).position_m() - camera.position_m()).norm() < 0.02);
  settings.estimates_distortion = false;
  CHECK(calibrate_camera(points, initial, settings).camera.distortion == initial.distortion);
}

TEST_CASE("points that do not determine the camera are refused with the reason") {
  const std::uint64_t seed = 12;
  CAPTURE(seed);
  Rng rng(seed);
  OverheadCamera overhead_camera;
  const CameraModel camera = overhead_camera_model(overhead_camera);
  const CameraParameters initial = initial_of(camera);
  const auto error = [&](const std::vector<CalibrationPoint>& points) {
    return calibrate_camera(points, initial).error;
  };
  CHECK_THAT(error({}), Equals("expected at least 5 points, got 0"));
  CHECK(error(noisy_points(camera, overhead_camera.view_m, 4, {0, 0.3}, 0, rng)).find("got 4") !=
        std::string::npos);

  // With points on the floor only, in a vertical view, a lower camera with a shorter focal length gives the
  // same image.
  CHECK(error(noisy_points(camera, overhead_camera.view_m, 60, {0}, 0.1, rng))
            .find("do not determine the camera") != std::string::npos);

  auto line = noisy_points(camera, {{-2, 1}, {2, 1}}, 20, {0}, 0.1, rng);
  CHECK(!error(line).empty());
  auto same = std::vector<CalibrationPoint>(20, line[0]);
  CHECK(!error(same).empty());
  auto broken = noisy_points(camera, overhead_camera.view_m, 20, {0, 0.3}, 0, rng);
  broken[7].pixel.x() = NAN;
  CHECK_THAT(error(broken), Equals("a point is not finite"));
  CameraParameters wrong = initial;
  wrong.width_px = 0;
  CHECK(!calibrate_camera(line, wrong).error.empty());
}

TEST_CASE("a tilted camera is determined by points on the floor") {
  const std::uint64_t seed = 13;
  CAPTURE(seed);
  Rng rng(seed);
  OverheadCamera overhead_camera;
  overhead_camera.lateral_offset_m = Vec2(-2.5, 1);
  const CameraModel camera = overhead_camera_model(overhead_camera);
  const auto points = noisy_points(camera, overhead_camera.view_m, 100, {0}, 0.1, rng);
  const CalibrationResult found = calibrate_camera(points, initial_of(camera));
  CAPTURE(found.error, found.robot_top_sd_px);
  REQUIRE(found.error.empty());
  CHECK(found.camera.focal_length_px == Approx(camera.parameters().focal_length_px).epsilon(0.01));
}

}  // namespace sidestep::camera_calibration_test
