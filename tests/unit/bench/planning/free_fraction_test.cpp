// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/planning/free_fraction.hpp"

#include "common/random/rng.hpp"
#include "deploy/trial/planning/worlds.hpp"
#include "tests/catch.hpp"

namespace sidestep::free_fraction_test {

TEST_CASE("the free fraction of a motion ends a micrometre before its first contact") {
  const ObstacleWorld obstacles({Box{{1, -1}, {2, 1}}});
  CHECK(free_fraction(obstacles, {0, 0}, {2, 0}, 0.1) == Approx(0.45).margin(1e-6));
  CHECK(free_fraction(obstacles, {0, 0}, {0.8, 0}, 0.1) == 1);
  CHECK(free_fraction(obstacles, {0, 0}, {0, 5}, 0.1) == 1);
}

TEST_CASE("a motion is free up to its free fraction and touches an obstacle just beyond") {
  const auto seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  const PlanWorld world = make_world("mixed", 1, seed);
  const ObstacleWorld obstacles(world.obstacles);
  Rng rng(seed);
  const auto random_position = [&] {
    const double y = rng.uniform(-5, 5), x = rng.uniform(-5, 5);
    return Vec2(x, y);
  };
  int blocked = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec2 from = random_position(), to = random_position();
    if (obstacles.touches(from, world.radius_m)) continue;
    const double fraction = free_fraction(obstacles, from, to, world.radius_m);
    const double beyond = std::min(1.0, fraction + 3e-6 / (to - from).norm());
    REQUIRE_FALSE(obstacles.touches(from, from + fraction * (to - from), world.radius_m));
    if (fraction == 1) continue;
    REQUIRE(obstacles.touches(from, to, world.radius_m));
    blocked += fraction > 0;
    if (fraction > 0) REQUIRE(obstacles.touches(from, from + beyond * (to - from), world.radius_m));
  }
  CHECK(blocked > 500);
}

}  // namespace sidestep::free_fraction_test
