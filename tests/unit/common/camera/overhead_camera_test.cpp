// SPDX-License-Identifier: Apache-2.0
#include "common/camera/overhead_camera.hpp"

#include <stdexcept>

#include "tests/catch.hpp"
#include "tests/unit/common/camera/random_camera.hpp"

namespace sidestep::overhead_camera_test {

TEST_CASE("an overhead camera sees its whole rectangle and little beyond it") {
  const std::uint64_t seed = 6;
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 300; ++i) {
    const OverheadCamera mount = random_overhead_camera(rng);
    const CameraModel camera = overhead_camera_model(mount);
    double margin_px = 1e9;
    for (int j = 0; j < 500; ++j) {
      Vec2 p = random_point_in(mount.view_m, rng);
      // Half of the points lie on the border.
      if (j % 4 == 0) p.x() = mount.view_m.min_m.x();
      if (j % 4 == 1) p.y() = mount.view_m.max_m.y();
      const Vec2 pixel = *camera.pixel_of(Vec3(p.x(), p.y(), j % 8 < 4 ? 0 : mount.object_height_m));
      REQUIRE(pixel.x() >= -0.6);
      REQUIRE(pixel.y() >= -0.6);
      REQUIRE(pixel.x() <= camera.parameters().width_px - 0.4);
      REQUIRE(pixel.y() <= camera.parameters().height_px - 0.4);
    }
    for (const Vec2& p : corners_of(mount.view_m)) {
      for (const double z : {0.0, mount.object_height_m}) {
        const Vec2 pixel = *camera.pixel_of(Vec3(p.x(), p.y(), z));
        margin_px = std::min({margin_px, pixel.x(), pixel.y(), camera.parameters().width_px - 1 - pixel.x(),
                              camera.parameters().height_px - 1 - pixel.y()});
      }
    }
    // With barrel distortion the middle of a side may lie closer to the image border than the corners.
    CHECK(margin_px < 0.12 * camera.parameters().width_px);
    const Vec2 centre = (mount.view_m.min_m + mount.view_m.max_m) / 2;
    CHECK(
        (*camera.pixel_of(Vec3(centre.x(), centre.y(), 0)) - camera.parameters().principal_point_px).norm() <
        1e-9);
    const Vec2 mount_m = centre + mount.lateral_offset_m;
    CHECK((camera.position_m() - Vec3(mount_m.x(), mount_m.y(), mount.height_m)).norm() < 1e-12);
  }
}

TEST_CASE("the long side of the image is parallel to the long side of the rectangle") {
  OverheadCamera mount;
  const CameraModel along = overhead_camera_model(mount);
  CHECK((*along.pixel_of(Vec3(1, 0, 0))).x() > 400);
  CHECK((*along.pixel_of(Vec3(0, 1, 0))).y() < 280);
  mount.view_m = {{-2.25, -3}, {2.25, 3}};
  const CameraModel across = overhead_camera_model(mount);
  CHECK((*across.pixel_of(Vec3(0, 1, 0))).x() > 400);
  CHECK(across.parameters().focal_length_px == Approx(along.parameters().focal_length_px));
}

TEST_CASE("a camera that cannot cover its rectangle is rejected") {
  OverheadCamera mount;
  mount.height_m = 0.1;
  CHECK_THROWS_AS(overhead_camera_model(mount), std::invalid_argument);
  mount = {};
  mount.view_m = {{1, 1}, {1, 2}};
  CHECK_THROWS_AS(overhead_camera_model(mount), std::invalid_argument);
  mount = {};
  mount.distortion = -1;
  CHECK_THROWS_AS(overhead_camera_model(mount), std::invalid_argument);
}

}  // namespace sidestep::overhead_camera_test
