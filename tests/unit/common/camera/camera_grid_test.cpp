// SPDX-License-Identifier: Apache-2.0
#include "common/camera/camera_grid.hpp"

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::camera_grid_test {

TEST_CASE("a grid of cameras covers the whole field with the required overlap") {
  const Field field{12, 9};
  VisionSpec spec;
  spec.columns = 2;
  spec.rows = 2;
  spec.overlap_m = 0.25;
  const auto cameras = camera_grid(field, spec, OverheadCamera{});
  REQUIRE(cameras.size() == 4);
  Rng rng(66);
  for (int i = 0; i < 2000; ++i) {
    const double z = rng.uniform(0, 0.15), y = rng.uniform(-4.7, 4.7), x = rng.uniform(-6.2, 6.2);
    const Vec3 p(x, y, z);
    int seen = 0;
    for (const CameraModel& camera : cameras) seen += camera.is_in_image(*camera.pixel_of(p));
    CHECK(seen >= 1);
    if (p.head<2>().cwiseAbs().maxCoeff() < 0.24) CHECK(seen == 4);
  }
  CHECK(cameras[0].position_m().head<2>() == Vec2(-3, -2.25));
  CHECK(cameras[3].position_m().head<2>() == Vec2(3, 2.25));
}

}  // namespace sidestep::camera_grid_test
