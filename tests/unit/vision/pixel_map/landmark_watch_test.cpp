// SPDX-License-Identifier: Apache-2.0
#include "vision/pixel_map/landmark_watch.hpp"

#include <stdexcept>

#include "common/camera/overhead_camera.hpp"
#include "common/marking/butterfly.hpp"
#include "simulator/rendering/frame_renderer.hpp"
#include "tests/catch.hpp"

namespace sidestep::landmark_watch_test {

constexpr Field kField{5.4, 4};

CameraModel camera_over_field() {
  OverheadCamera overhead;
  overhead.width_px = 800;
  overhead.height_px = 600;
  return overhead_camera_model(overhead);
}

/// The camera, turned about an axis through its centre.
CameraModel turned(const CameraModel& camera, const Vec3& axis, double angle_rad) {
  const Eigen::AngleAxisd turn(angle_rad, axis.normalized());
  CameraParameters parameters = camera.parameters();
  parameters.rotation = Eigen::Quaterniond(turn) * parameters.rotation;
  parameters.translation_m = turn * parameters.translation_m;
  return CameraModel(parameters);
}

/// The largest displacement in the image among the floor's centre, corners and edge midpoints.
double displacement_px(const CameraModel& a, const CameraModel& b) {
  double largest = 0;
  for (const double x : {-2.0, 0.0, 2.0})
    for (const double y : {-1.5, 0.0, 1.5})
      largest = std::max(largest, (*a.pixel_of({x, y, 0}) - *b.pixel_of({x, y, 0})).norm());
  return largest;
}

Image random_view(const CameraModel& camera, Rng& rng) {
  RenderSpec spec;
  spec.far_light = rng.uniform(0.6, 1);
  std::vector<SceneRobot> robots(4);
  std::vector<SceneCylinder> cylinders(6);
  for (SceneRobot& robot : robots) {
    const double x = rng.uniform(-2.6, 2.6), y = rng.uniform(-1.9, 1.9);
    robot.position_m = {x, y};
  }
  for (SceneCylinder& cylinder : cylinders) {
    const double x = rng.uniform(-2.6, 2.6), y = rng.uniform(-1.9, 1.9);
    cylinder.circle = {{x, y}, rng.uniform(0.08, 0.3)};
  }
  FrameRenderer renderer(camera, kField, butterfly(), spec, Rng(rng.bits()));
  return renderer.render({robots, cylinders});
}

TEST_CASE("a camera that has not moved counts as known, with any objects on the floor and in any light") {
  LandmarkWatch watch(camera_over_field(), kField);
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Rng rng(seed);
    const Image image = random_view(camera_over_field(), rng);
    CAPTURE(seed);
    REQUIRE(watch.update(image.view()));
  }
}

TEST_CASE("an image displacement of four pixels or more is noticed in the first image") {
  const CameraModel camera = camera_over_field();
  int bumps = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Rng rng(seed);
    const double x = rng.normal(), y = rng.normal(), z = rng.normal(), angle_rad = rng.uniform(0.003, 0.06);
    const CameraModel moved = turned(camera, {x, y, z}, angle_rad);
    if (displacement_px(camera, moved) < 4) continue;
    ++bumps;
    LandmarkWatch watch(camera, kField);
    CAPTURE(seed, x, y, z, angle_rad, displacement_px(camera, moved));
    REQUIRE_FALSE(watch.update(random_view(moved, rng).view()));
    REQUIRE_FALSE(watch.is_known());
  }
  CHECK(bumps > 25);
}

TEST_CASE("a lost camera is known again only after several consecutive good images") {
  const CameraModel camera = camera_over_field(), moved = turned(camera, {1, 0, 0}, 0.02);
  Rng rng(1);
  const Image good = random_view(camera, rng), bad = random_view(moved, rng);
  LandmarkWatch watch(camera, kField);
  REQUIRE(watch.update(good.view()));
  REQUIRE_FALSE(watch.update(bad.view()));
  for (int i = 0; i < 4; ++i) REQUIRE_FALSE(watch.update(good.view()));
  REQUIRE_FALSE(watch.update(bad.view()));
  for (int i = 0; i < 4; ++i) REQUIRE_FALSE(watch.update(good.view()));
  CHECK(watch.update(good.view()));
}

TEST_CASE("a camera whose image lacks the field's lines is not known") {
  LandmarkWatch watch(camera_over_field(), kField);
  const Image black(PixelFormat::kYuv422, 800, 600);
  CHECK_FALSE(watch.update(black.view()));
}

TEST_CASE("a camera that sees too little of the lines is refused") {
  OverheadCamera overhead;
  overhead.view_m = {{0.5, 0.6}, {0.9, 0.9}};
  CHECK_THROWS_AS(LandmarkWatch(overhead_camera_model(overhead), kField), std::invalid_argument);
}

}  // namespace sidestep::landmark_watch_test
