// SPDX-License-Identifier: Apache-2.0
#include "common/camera/camera_model.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/unit/common/camera/random_camera.hpp"

using namespace sidestep;

namespace {

/// As ssl-vision writes it: the quaternion's product, and the cubic's solution by Cardano's formula.
Vec2 slow_pixel(const CameraParameters& c, const Vec3& point_m) {
  const Eigen::Quaterniond q = c.rotation;
  const Eigen::Quaterniond v(0, point_m.x(), point_m.y(), point_m.z());
  const Vec3 p = (q * v * q.conjugate()).vec() + c.translation_m;
  const Vec2 sight(p.x() / p.z(), p.y() / p.z());
  const double ru = sight.norm(), k = c.distortion;
  double rd = ru;
  if (k > 0) {
    const double b = std::cbrt(-9 * k * k * ru + k * std::sqrt(k * (12 + 81 * k * ru * ru)));
    rd = std::cbrt(2.0 / 3) / b - b / (std::cbrt(18.0) * k);
  }
  return c.focal_length_px * (ru > 0 ? rd / ru : 1) * sight + c.principal_point_px;
}

}  // namespace

TEST_CASE("a camera projects as the league defines it") {
  const std::uint64_t seed = 3;
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 2000; ++i) {
    const OverheadCamera hanging = random_overhead_camera(rng);
    const CameraModel camera = hang(hanging);
    const Vec2 p = random_point_in(hanging.view_m, rng);
    const Vec3 point(p.x(), p.y(), rng.uniform(0, 0.15));
    const auto pixel = camera.pixel_of(point);
    REQUIRE(pixel);
    // Cardano's formula cancels where the distortion is small.
    REQUIRE((*pixel - slow_pixel(camera.parameters(), point)).norm() < 1e-5);
  }
}

TEST_CASE("a point goes to its pixel and comes back") {
  const std::uint64_t seed = 4;
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 5000; ++i) {
    const OverheadCamera hanging = random_overhead_camera(rng);
    const CameraModel camera = hang(hanging);
    const Vec2 p = random_point_in(hanging.view_m, rng);
    const double height_m = rng.uniform(0, 0.3);
    const auto pixel = camera.pixel_of(Vec3(p.x(), p.y(), height_m));
    REQUIRE(pixel);
    const auto back = camera.point_at(*pixel, height_m);
    REQUIRE(back);
    REQUIRE((*back - p).norm() < 1e-11);
    const Vec2 anywhere(rng.uniform(0, 780), rng.uniform(0, 580));
    const auto there = camera.point_at(anywhere, height_m);
    if (!there) continue;
    const auto again = camera.pixel_of(Vec3(there->x(), there->y(), height_m));
    REQUIRE(again);
    REQUIRE((*again - anywhere).norm() < 1e-8);
  }
}

TEST_CASE("pixels per metre are the slope of the projection") {
  const std::uint64_t seed = 5;
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 2000; ++i) {
    const OverheadCamera hanging = random_overhead_camera(rng);
    const CameraModel camera = hang(hanging);
    const Vec2 p = random_point_in(hanging.view_m, rng);
    const Vec3 point(p.x(), p.y(), rng.uniform(0, 0.15));
    const auto slope = camera.pixels_per_metre(point);
    REQUIRE(slope);
    const double step_m = 1e-5;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 step = step_m * Vec3::Unit(axis);
      const Vec2 difference =
          (*camera.pixel_of(point + step) - *camera.pixel_of(point - step)) / (2 * step_m);
      REQUIRE((difference - slope->col(axis)).norm() < 1e-5 * slope->norm());
    }
  }
}

TEST_CASE("a camera does not see what is behind it or beyond its lens") {
  CameraParameters parameters;  // 4 m over the origin, looking down
  const CameraModel camera(parameters);
  CHECK((camera.position_m() - Vec3(0, 0, 4)).norm() < 1e-15);
  CHECK((*camera.pixel_of(Vec3(1, 0.5, 0)) - Vec2(389.5 + 150, 289.5 - 75)).norm() < 1e-12);
  CHECK(!camera.pixel_of(Vec3(0, 0, 4)));
  CHECK(!camera.pixel_of(Vec3(0, 0, 5)));
  CHECK(!camera.pixels_per_metre(Vec3(0, 0, 5)));
  CHECK(!camera.point_at(Vec2(100, 100), 4));
  CHECK(!camera.point_at(Vec2(100, 100), 4.5));

  parameters.distortion = -0.2;  // the lens ends at r_d² = 1.5, 735 pixels from the middle
  const CameraModel pincushion(parameters);
  CHECK(pincushion.point_at(parameters.principal_point_px + Vec2(734, 0), 0));
  CHECK(!pincushion.point_at(parameters.principal_point_px + Vec2(736, 0), 0));
  CHECK(pincushion.pixel_of(Vec3(3.42, 0, 0)));
  CHECK(!pincushion.pixel_of(Vec3(3.44, 0, 0)));

  parameters.distortion = 0;
  parameters.rotation = Eigen::AngleAxisd(0.6 * M_PI, Vec3::UnitX());  // it sees the horizon
  const CameraModel level(parameters);
  int seen = 0, sky = 0;
  for (int y = 0; y < 580; ++y) ++(level.point_at(Vec2(390, y), 0) ? seen : sky);
  CHECK(seen > 100);
  CHECK(sky > 50);
}

TEST_CASE("an image reaches half a pixel beyond the centres of its outermost pixels") {
  const CameraModel camera(CameraParameters{});
  CHECK(camera.shows(Vec2(-0.5, -0.5)));
  CHECK(camera.shows(Vec2(779.49, 579.49)));
  CHECK(!camera.shows(Vec2(779.5, 100)));
  CHECK(!camera.shows(Vec2(-0.51, 100)));
  CHECK(!camera.shows(Vec2(100, 579.5)));
  CHECK(!camera.shows(Vec2(NAN, 100)));
}

TEST_CASE("numbers that make no camera are refused") {
  const auto refused = [](auto change) {
    CameraParameters parameters;
    change(parameters);
    CHECK(!fault_of(parameters).empty());
    CHECK_THROWS_AS(CameraModel(parameters), std::invalid_argument);
  };
  refused([](CameraParameters& c) { c.width_px = 0; });
  refused([](CameraParameters& c) { c.height_px = 20000; });
  refused([](CameraParameters& c) { c.focal_length_px = 0; });
  refused([](CameraParameters& c) { c.focal_length_px = NAN; });
  refused([](CameraParameters& c) { c.principal_point_px.x() = INFINITY; });
  refused([](CameraParameters& c) { c.distortion = NAN; });
  refused([](CameraParameters& c) { c.rotation = Eigen::Quaterniond(0, 0, 0, 0); });
  refused([](CameraParameters& c) { c.rotation = Eigen::Quaterniond(1, 1, 0, 0); });
  refused([](CameraParameters& c) { c.translation_m.z() = NAN; });
  CHECK(fault_of(CameraParameters{}).empty());
}
