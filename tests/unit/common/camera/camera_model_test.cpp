// SPDX-License-Identifier: Apache-2.0
#include "common/camera/camera_model.hpp"

#include <cmath>
#include <numbers>

#include "tests/catch.hpp"
#include "tests/unit/common/camera/random_camera.hpp"

namespace sidestep::camera_model_test {

/// The projection as implemented by ssl-vision: quaternion products, and Cardano's formula for the cubic.
Vec2 reference_pixel(const CameraParameters& c, const Vec3& point_m) {
  const Eigen::Quaterniond q = c.rotation;
  const Eigen::Quaterniond v(0, point_m.x(), point_m.y(), point_m.z());
  const Vec3 p = (q * v * q.conjugate()).vec() + c.translation_m;
  const Vec2 undistorted(p.x() / p.z(), p.y() / p.z());
  const double ru = undistorted.norm(), k = c.distortion;
  double rd = ru;
  if (k > 0) {
    const double b = std::cbrt(-9 * k * k * ru + k * std::sqrt(k * (12 + 81 * k * ru * ru)));
    rd = std::cbrt(2.0 / 3) / b - b / (std::cbrt(18.0) * k);
  }
  return c.focal_length_px * (ru > 0 ? rd / ru : 1) * undistorted + c.principal_point_px;
}

TEST_CASE("the projection matches the league's definition") {
  const std::uint64_t seed = 3;
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 2000; ++i) {
    const OverheadCamera mount = random_overhead_camera(rng);
    const CameraModel camera = overhead_camera_model(mount);
    const Vec2 p = random_point_in(mount.view_m, rng);
    const Vec3 point(p.x(), p.y(), rng.uniform(0, 0.15));
    const auto pixel = camera.pixel_of(point);
    REQUIRE(pixel);
    // Cardano's formula loses digits by cancellation where the distortion is small.
    REQUIRE((*pixel - reference_pixel(camera.parameters(), point)).norm() < 1e-5);
  }
}

TEST_CASE("back-projecting a pixel recovers the projected point") {
  const std::uint64_t seed = 4;
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 5000; ++i) {
    const OverheadCamera mount = random_overhead_camera(rng);
    const CameraModel camera = overhead_camera_model(mount);
    const Vec2 p = random_point_in(mount.view_m, rng);
    const double height_m = rng.uniform(0, 0.3);
    const auto pixel = camera.pixel_of(Vec3(p.x(), p.y(), height_m));
    REQUIRE(pixel);
    const auto recovered = camera.point_at(*pixel, height_m);
    REQUIRE(recovered);
    REQUIRE((*recovered - p).norm() < 1e-11);
    const double y = rng.uniform(0, 580), x = rng.uniform(0, 780);
    const Vec2 random_pixel(x, y);
    const auto point = camera.point_at(random_pixel, height_m);
    if (!point) continue;
    const auto again = camera.pixel_of(Vec3(point->x(), point->y(), height_m));
    REQUIRE(again);
    REQUIRE((*again - random_pixel).norm() < 1e-8);
  }
}

TEST_CASE("the Jacobian is the derivative of the projection") {
  const std::uint64_t seed = 5;
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 2000; ++i) {
    const OverheadCamera mount = random_overhead_camera(rng);
    const CameraModel camera = overhead_camera_model(mount);
    const Vec2 p = random_point_in(mount.view_m, rng);
    const Vec3 point(p.x(), p.y(), rng.uniform(0, 0.15));
    const auto jacobian = camera.projection_jacobian(point);
    REQUIRE(jacobian);
    const double step_m = 1e-5;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 step = step_m * Vec3::Unit(axis);
      const Vec2 difference =
          (*camera.pixel_of(point + step) - *camera.pixel_of(point - step)) / (2 * step_m);
      REQUIRE((difference - jacobian->col(axis)).norm() < 1e-5 * jacobian->norm());
    }
  }
}

TEST_CASE("a camera sees neither points behind it nor points outside the domain of its lens") {
  CameraParameters parameters;  // 4 m above the origin, looking down
  const CameraModel camera(parameters);
  CHECK((camera.position_m() - Vec3(0, 0, 4)).norm() < 1e-15);
  CHECK((*camera.pixel_of(Vec3(1, 0.5, 0)) - Vec2(389.5 + 150, 289.5 - 75)).norm() < 1e-12);
  CHECK(!camera.pixel_of(Vec3(0, 0, 4)));
  CHECK(!camera.pixel_of(Vec3(0, 0, 5)));
  CHECK(!camera.projection_jacobian(Vec3(0, 0, 5)));
  CHECK(!camera.point_at(Vec2(100, 100), 4));
  CHECK(!camera.point_at(Vec2(100, 100), 4.5));

  parameters.distortion = -0.2;  // the domain ends at r_d² = 1.5, 735 pixels from the principal point
  const CameraModel pincushion(parameters);
  CHECK(pincushion.point_at(parameters.principal_point_px + Vec2(734, 0), 0));
  CHECK(!pincushion.point_at(parameters.principal_point_px + Vec2(736, 0), 0));
  CHECK(pincushion.pixel_of(Vec3(3.42, 0, 0)));
  CHECK(!pincushion.pixel_of(Vec3(3.44, 0, 0)));

  parameters.distortion = 0;
  parameters.rotation = Eigen::AngleAxisd(0.6 * std::numbers::pi, Vec3::UnitX());  // the horizon is in view
  const CameraModel tilted(parameters);
  int floor = 0, sky = 0;
  for (int y = 0; y < 580; ++y) ++(tilted.point_at(Vec2(390, y), 0) ? floor : sky);
  CHECK(floor > 100);
  CHECK(sky > 50);
}

TEST_CASE("an image extends half a pixel beyond the centres of its outermost pixels") {
  const CameraModel camera(CameraParameters{});
  CHECK(camera.is_in_image(Vec2(-0.5, -0.5)));
  CHECK(camera.is_in_image(Vec2(779.49, 579.49)));
  CHECK(!camera.is_in_image(Vec2(779.5, 100)));
  CHECK(!camera.is_in_image(Vec2(-0.51, 100)));
  CHECK(!camera.is_in_image(Vec2(100, 579.5)));
  CHECK(!camera.is_in_image(Vec2(NAN, 100)));
}

TEST_CASE("invalid camera parameters are rejected") {
  const auto check_rejected = [](auto change) {
    CameraParameters parameters;
    change(parameters);
    CHECK(!validation_error(parameters).empty());
    CHECK_THROWS_AS(CameraModel(parameters), std::invalid_argument);
  };
  check_rejected([](CameraParameters& c) { c.width_px = 0; });
  check_rejected([](CameraParameters& c) { c.height_px = 20000; });
  check_rejected([](CameraParameters& c) { c.focal_length_px = 0; });
  check_rejected([](CameraParameters& c) { c.focal_length_px = NAN; });
  check_rejected([](CameraParameters& c) { c.principal_point_px.x() = INFINITY; });
  check_rejected([](CameraParameters& c) { c.distortion = NAN; });
  check_rejected([](CameraParameters& c) { c.rotation = Eigen::Quaterniond(0, 0, 0, 0); });
  check_rejected([](CameraParameters& c) { c.rotation = Eigen::Quaterniond(1, 1, 0, 0); });
  check_rejected([](CameraParameters& c) { c.translation_m.z() = NAN; });
  CHECK(validation_error(CameraParameters{}).empty());
}

}  // namespace sidestep::camera_model_test
