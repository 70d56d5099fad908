// SPDX-License-Identifier: Apache-2.0
#include "common/collision/obstacle_world.hpp"
#include "tests/catch.hpp"
#include "tests/counted_allocations.hpp"
#include "tests/unit/common/collision/random_world.hpp"

namespace sidestep::allocation_test {

TEST_CASE("the allocation counter counts an allocation") {
  const std::size_t before = allocation_count();
  const std::vector<int> numbers(100);
  CHECK(numbers.size() == 100);
  CHECK(allocation_count() > before);
}

TEST_CASE("collision queries do not allocate memory") {
  const Structure structure = GENERATE(Structure::kLinear, Structure::kMasks, Structure::kTree);
  const std::uint64_t seed = GENERATE(1, 2);
  CAPTURE(structure, seed);
  Rng rng(seed);
  const ObstacleWorld world(random_shapes(rng, 200, 3), structure);
  std::size_t touched = 0, found = 0;
  const std::size_t before = allocation_count();
  for (int i = 0; i < 500; ++i) {
    const Vec2 from = random_position(rng, 3), to = from + random_displacement(rng, 1);
    touched += world.touches(from, to, 0.1);
    found += world.first_contact(from, to, 0.1).has_value();
    found += world.nearest(from).distance_m < 0.1;
  }
  CHECK(allocation_count() == before);
  CHECK(touched > 0);
  CHECK(found > 0);
}

}  // namespace sidestep::allocation_test
