// SPDX-License-Identifier: Apache-2.0
#include "agents/perception/prior_map.hpp"

#include "tests/catch.hpp"
#include "tests/unit/agents/perception/scene.hpp"

namespace sidestep::prior_map_test {

TEST_CASE("the nearest known point lies on the nearest stationary object, at that object's distance") {
  int found = 0, none = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const test::Scene scene(seed);
    const ObstacleWorld world({Circle{{1, 1}, 0.3}, Box{{-2, -1}, {-1, 2}}, Segment{{0, -3}, {3, -2}}});
    const bool has_map = rng.chance(0.7), has_shapes = !has_map || rng.chance(0.5);
    const PriorMap floor{has_map ? &scene.map() : nullptr, has_shapes ? &world : nullptr};
    for (int i = 0; i < 200; ++i) {
      const double x = rng.uniform(-6.3, 6.3), y = rng.uniform(-6.3, 6.3), within_m = rng.uniform(0.05, 0.5);
      const Vec2 p(x, y);
      double expected_m = has_map ? scene.map().distance_m(p) : 1e9;
      if (has_shapes) expected_m = std::min(expected_m, std::max(0.0, world.nearest(p).distance_m));
      const auto nearest = floor.nearest_m(p, within_m);
      REQUIRE(nearest.has_value() == (expected_m < within_m));
      (nearest ? found : none) += 1;
      if (!nearest) continue;
      CHECK((*nearest - p).norm() == Approx(expected_m).margin(1e-9));
      const double to_map_m = has_map ? scene.map().distance_m(*nearest) : 1e9;
      const double to_shapes_m = has_shapes ? world.nearest(*nearest).distance_m : 1e9;
      CHECK(std::min(to_map_m, to_shapes_m) < 1e-9);
    }
  }
  CHECK(found > 500);
  CHECK(none > 500);
}

}  // namespace sidestep::prior_map_test
