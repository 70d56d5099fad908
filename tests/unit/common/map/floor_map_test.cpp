// SPDX-License-Identifier: Apache-2.0
#include "common/map/floor_map.hpp"

#include <algorithm>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::floor_map_test {

//   +-----------+   field
//   |  +--+     |   map with blocked cells; everything around it is blocked
//   |  |# |     |
//   |  +--+     |
//   +-----------+
TEST_CASE("the boxes of a map smaller than the field cover its blocked cells and the area around it") {
  int blocked = 0, free = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    MapGrid grid{10, 8, 0.25, {rng.uniform(-3, 1), rng.uniform(-3, 1)}};
    BitGrid bits(grid.columns, grid.rows);
    for (int row = 0; row < grid.rows; ++row)
      for (int column = 0; column < grid.columns; ++column)
        if (rng.chance(0.3)) bits.set(column, row);
    const FloorMap map(OccupancyMap(grid, std::move(bits)));
    const Field field{8, 6};
    const std::vector<Box> boxes = map.boxes_on(field);
    for (int i = 0; i < 500; ++i) {
      const Vec2 p(rng.uniform(-5, 5), rng.uniform(-4, 4));
      const bool is_covered =
          std::ranges::any_of(boxes, [&](const Box& box) { return signed_distance(p, box) <= 0; });
      REQUIRE(is_covered == (map.cells().distance_m(p, 1) == 0));
      (is_covered ? blocked : free) += 1;
    }
  }
  CHECK(blocked > 5000);
  CHECK(free > 500);
}

}  // namespace sidestep::floor_map_test
