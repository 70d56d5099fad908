// SPDX-License-Identifier: Apache-2.0
#include "common/map/laser_scanner.hpp"
#include "tests/catch.hpp"
#include "tests/counted_allocations.hpp"
#include "tests/unit/common/collision/random_world.hpp"
#include "tests/unit/common/map/random_map.hpp"

namespace sidestep::map_allocation_test {

TEST_CASE("map queries and laser scans do not allocate memory") {
  const std::uint64_t seed = GENERATE(1, 2);
  CAPTURE(seed);
  Rng rng(seed);
  const MapGrid grid{400, 400, 0.05, {-10, -10}};
  const OccupancyMap map = make_floor_plan(seed, grid);
  const DistanceField field(map);
  const ObstacleWorld shapes(random_shapes(rng, 50, 10));
  const std::vector<Circle> discs{{{1, 1}, 0.3}, {{-2, 3}, 0.3}};
  const LaserScanner scanner({90, 4, 0.05, 10});
  std::vector<float> ranges_m(90);
  std::size_t boxes = 0, touching = 0, seen = 0;
  double sum_m = 0;
  const std::size_t before = allocation_count();
  for (int i = 0; i < 200; ++i) {
    const Vec2 from = random_position(rng, 10), to = from + random_displacement(rng, 3);
    sum_m += map.distance_m(from, 2) + field.lower_bound_m(from);
    touching += touches(map, field, from, to, 0.2);
    map.for_each_box({from.cwiseMin(to), from.cwiseMax(to)}, [&](const Box&) { return ++boxes > 0; });
    scanner.scan({&map, &field, &shapes, discs}, from, sum_m, ranges_m);
    for (const float range_m : ranges_m) seen += std::isfinite(range_m);
  }
  CHECK(allocation_count() == before);
  CHECK(boxes > 0);
  CHECK(touching > 0);
  CHECK(seen > 0);
  CHECK(sum_m > 0);
}

}  // namespace sidestep::map_allocation_test
