// SPDX-License-Identifier: Apache-2.0
#include "vision/cameras/camera_calibration.hpp"

#include <catch2/catch.hpp>
#include <vector>

#include "tests/unit/common/camera/random_camera.hpp"

using namespace sidestep;

namespace {

/// As many points at the heights given as there are, seen with noise.
std::vector<CalibrationPoint> seen_points(const CameraModel& camera, const Box& view_m, int count,
                                          const std::vector<double>& heights_m, double noise_px, Rng& rng) {
  std::vector<CalibrationPoint> points;
  for (int i = 0; i < count; ++i) {
    const Vec2 p = random_point_in(view_m, rng);
    const Vec3 point(p.x(), p.y(), heights_m[static_cast<std::size_t>(i) % heights_m.size()]);
    const Vec2 noise(rng.normal(), rng.normal());
    points.push_back({point, *camera.pixel_of(point) + noise_px * noise});
  }
  return points;
}

/// What a user knows: the image's size.
CameraParameters start_of(const CameraModel& camera) {
  CameraParameters start;
  start.width_px = camera.parameters().width_px;
  start.height_px = camera.parameters().height_px;
  start.principal_point_px = Vec2(start.width_px - 1, start.height_px - 1) / 2;
  return start;
}

}  // namespace

TEST_CASE("a camera is found again from points without noise") {
  const std::uint64_t seed = 9;
  CAPTURE(seed);
  Rng rng(seed);
  int settled = 0;
  for (int i = 0; i < 60; ++i) {
    CAPTURE(i);
    const OverheadCamera hanging = random_overhead_camera(rng);
    const CameraModel camera = hang(hanging);
    const auto points = seen_points(camera, hanging.view_m, 30, {0, 0.15, 0.5}, 0, rng);
    const CalibrationResult found = calibrate_camera(points, start_of(camera));
    CAPTURE(found.fault, found.rms_px, found.top_sd_px, hanging.distortion);
    // A narrow view from high up leaves focal length and height close together.
    if (!found.fault.empty() && found.top_sd_px > 0.5) continue;
    REQUIRE(found.fault.empty());
    const CameraParameters& truth = camera.parameters();
    ++settled;
    CHECK(found.rms_px < 1e-6);
    CHECK(found.rms_m < 1e-8);
    CHECK(found.camera.focal_length_px == Approx(truth.focal_length_px).epsilon(1e-5));
    CHECK(found.camera.distortion == Approx(truth.distortion).margin(1e-5));
    CHECK((CameraModel(found.camera).position_m() - camera.position_m()).norm() < 1e-4);
    CHECK(std::abs(found.camera.rotation.dot(truth.rotation)) == Approx(1).epsilon(1e-9));
  }
  CHECK(settled >= 55);
}

TEST_CASE("noisy points give a camera that is right on the floor and at the height of robots") {
  const std::uint64_t seed = 10;
  CAPTURE(seed);
  Rng rng(seed);
  OverheadCamera hanging;
  hanging.aside_m = Vec2(0.4, -0.3);
  const CameraModel camera = hang(hanging);
  CalibrationSettings settings;
  settings.finds_principal_point = GENERATE(false, true);
  CAPTURE(settings.finds_principal_point);
  double sum = 0;
  int count = 0;
  for (int trial = 0; trial < 10; ++trial) {
    const auto points = seen_points(camera, hanging.view_m, 60, {0, 0.15, 0.6}, 0.2, rng);
    const CalibrationResult found = calibrate_camera(points, start_of(camera), settings);
    CAPTURE(found.fault);
    REQUIRE(found.fault.empty());
    // Two axes of 0.2 pixels.
    CHECK(found.rms_px > 0.2);
    CHECK(found.rms_px < 0.36);
    CHECK(found.rms_m > 0.001);
    CHECK(found.rms_m < 0.004);
    const CameraModel model(found.camera);
    for (int i = 0; i < 200; ++i) {
      const Vec2 p = random_point_in(hanging.view_m, rng);
      const Vec3 point(p.x(), p.y(), i % 2 == 0 ? 0 : 0.15);
      const double error_px = (*model.pixel_of(point) - *camera.pixel_of(point)).norm();
      CHECK(error_px < 5 * found.top_sd_px);
      sum += error_px * error_px;
      ++count;
    }
  }
  CHECK(std::sqrt(sum / count) < 0.15);
}

TEST_CASE("what was known before stays as it was") {
  const std::uint64_t seed = 11;
  CAPTURE(seed);
  Rng rng(seed);
  OverheadCamera hanging;
  const CameraModel camera = hang(hanging);  // straight from above, points on the floor alone
  const auto points = seen_points(camera, hanging.view_m, 40, {0}, 0.1, rng);
  CameraParameters start = camera.parameters();
  start.rotation = Eigen::Quaterniond::Identity();
  start.translation_m.setZero();
  CalibrationSettings settings;
  settings.finds_focal_length = false;
  const CalibrationResult found = calibrate_camera(points, start, settings);
  CAPTURE(found.fault);
  REQUIRE(found.fault.empty());
  CHECK(found.camera.focal_length_px == start.focal_length_px);
  CHECK(found.camera.principal_point_px == start.principal_point_px);
  CHECK(found.camera.distortion != start.distortion);
  CHECK((CameraModel(found.camera).position_m() - camera.position_m()).norm() < 0.02);
  settings.finds_distortion = false;
  CHECK(calibrate_camera(points, start, settings).camera.distortion == start.distortion);
}

TEST_CASE("points that do not settle the camera are refused with the reason") {
  const std::uint64_t seed = 12;
  CAPTURE(seed);
  Rng rng(seed);
  OverheadCamera hanging;
  const CameraModel camera = hang(hanging);
  const CameraParameters start = start_of(camera);
  const auto fault = [&](const std::vector<CalibrationPoint>& points) {
    return calibrate_camera(points, start).fault;
  };
  CHECK(fault({}) == "0 points are too few, expected at least 5");
  CHECK(fault(seen_points(camera, hanging.view_m, 4, {0, 0.3}, 0, rng)).find("too few") != std::string::npos);

  // The floor alone, straight from above: nearer with a shorter focal length looks the same.
  CHECK(fault(seen_points(camera, hanging.view_m, 60, {0}, 0.1, rng)).find("leave the camera open") !=
        std::string::npos);

  auto line = seen_points(camera, {{-2, 1}, {2, 1}}, 20, {0}, 0.1, rng);
  CHECK(!fault(line).empty());
  auto same = std::vector<CalibrationPoint>(20, line[0]);
  CHECK(!fault(same).empty());
  auto broken = seen_points(camera, hanging.view_m, 20, {0, 0.3}, 0, rng);
  broken[7].pixel.x() = NAN;
  CHECK(fault(broken) == "a point is not finite");
  CameraParameters wrong = start;
  wrong.width_px = 0;
  CHECK(!calibrate_camera(line, wrong).fault.empty());
}

TEST_CASE("a tilted camera needs no more than the floor") {
  const std::uint64_t seed = 13;
  CAPTURE(seed);
  Rng rng(seed);
  OverheadCamera hanging;
  hanging.aside_m = Vec2(-2.5, 1);
  const CameraModel camera = hang(hanging);
  const auto points = seen_points(camera, hanging.view_m, 100, {0}, 0.1, rng);
  const CalibrationResult found = calibrate_camera(points, start_of(camera));
  CAPTURE(found.fault, found.top_sd_px);
  REQUIRE(found.fault.empty());
  CHECK(found.camera.focal_length_px == Approx(camera.parameters().focal_length_px).epsilon(0.01));
}
