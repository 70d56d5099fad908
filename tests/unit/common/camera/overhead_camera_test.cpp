// SPDX-License-Identifier: Apache-2.0
#include "common/camera/overhead_camera.hpp"

#include <catch2/catch.hpp>
#include <stdexcept>

#include "tests/unit/common/camera/random_camera.hpp"

using namespace sidestep;

TEST_CASE("a camera that is hung over a rectangle sees all of it and not much more") {
  const std::uint64_t seed = 6;
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 300; ++i) {
    const OverheadCamera hanging = random_overhead_camera(rng);
    const CameraModel camera = hang(hanging);
    double margin_px = 1e9;
    for (int j = 0; j < 500; ++j) {
      Vec2 p = random_point_in(hanging.view_m, rng);
      // Half of them on the border.
      if (j % 4 == 0) p.x() = hanging.view_m.min_m.x();
      if (j % 4 == 1) p.y() = hanging.view_m.max_m.y();
      const Vec2 pixel = *camera.pixel_of(Vec3(p.x(), p.y(), j % 8 < 4 ? 0 : hanging.top_m));
      REQUIRE(pixel.x() >= -0.6);
      REQUIRE(pixel.y() >= -0.6);
      REQUIRE(pixel.x() <= camera.parameters().width_px - 0.4);
      REQUIRE(pixel.y() <= camera.parameters().height_px - 0.4);
    }
    for (const Vec2& p : corners_of(hanging.view_m)) {
      for (const double z : {0.0, hanging.top_m}) {
        const Vec2 pixel = *camera.pixel_of(Vec3(p.x(), p.y(), z));
        margin_px = std::min({margin_px, pixel.x(), pixel.y(), camera.parameters().width_px - 1 - pixel.x(),
                              camera.parameters().height_px - 1 - pixel.y()});
      }
    }
    // Barrel distortion may put the middle of a side farther out than the corners.
    CHECK(margin_px < 0.12 * camera.parameters().width_px);
    const Vec2 centre = (hanging.view_m.min_m + hanging.view_m.max_m) / 2;
    CHECK(
        (*camera.pixel_of(Vec3(centre.x(), centre.y(), 0)) - camera.parameters().principal_point_px).norm() <
        1e-9);
    const Vec2 above = centre + hanging.aside_m;
    CHECK((camera.position_m() - Vec3(above.x(), above.y(), hanging.height_m)).norm() < 1e-12);
  }
}

TEST_CASE("an image lies as its rectangle does") {
  OverheadCamera hanging;
  const CameraModel along = hang(hanging);
  CHECK((*along.pixel_of(Vec3(1, 0, 0))).x() > 400);
  CHECK((*along.pixel_of(Vec3(0, 1, 0))).y() < 280);
  hanging.view_m = {{-2.25, -3}, {2.25, 3}};
  const CameraModel across = hang(hanging);
  CHECK((*across.pixel_of(Vec3(0, 1, 0))).x() > 400);
  CHECK(across.parameters().focal_length_px == Approx(along.parameters().focal_length_px));
}

TEST_CASE("a camera that cannot see its rectangle is refused") {
  OverheadCamera hanging;
  hanging.height_m = 0.1;
  CHECK_THROWS_AS(hang(hanging), std::invalid_argument);
  hanging = {};
  hanging.view_m = {{1, 1}, {1, 2}};
  CHECK_THROWS_AS(hang(hanging), std::invalid_argument);
  hanging = {};
  hanging.distortion = -1;
  CHECK_THROWS_AS(hang(hanging), std::invalid_argument);
}
