// SPDX-License-Identifier: Apache-2.0
#include "common/collision/sweep_by_distance.hpp"

#include <limits>

#include "common/collision/obstacle_world.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/collision/random_world.hpp"

namespace sidestep::sweep_by_distance_test {

TEST_CASE("sweeps by distance agree with exact sweeps") {
  const std::uint64_t seed = GENERATE(range(1, 20));
  CAPTURE(seed);
  Rng rng(seed);
  const ObstacleWorld world(random_shapes(rng, 60, 3));
  for (int i = 0; i < 200; ++i) {
    const Vec2 from = random_position(rng, 3),
               to = rng.chance(0.1) ? from : from + random_displacement(rng, 2);
    const double radius = rng.uniform(0, 0.2);
    const SweepByDistance sweep(from, to, radius,
                                [&](const Vec2& at) { return world.nearest(at).distance_m; });
    CAPTURE(from.x(), from.y(), to.x(), to.y(), radius);
    if (world.touches(from, to, radius)) CHECK(sweep.touches());
    if (!world.touches(from, to, radius + 2 * kGrazing_m)) CHECK_FALSE(sweep.touches());
    const double length = (to - from).norm(), free = sweep.free_path_m();
    const std::optional<Contact> contact = world.first_contact(from, to, radius);
    CHECK(free <= length);
    if (contact) CHECK(free <= contact->fraction * length + 1e-12);
    if (free < length)
      CHECK(world.nearest(from + free / length * (to - from)).distance_m <= radius + 1.001 * kGrazing_m);
  }
}

TEST_CASE("a clear path needs few distance queries and a grazing path a bounded number") {
  const Circle circle{{0, 0}, 1};
  int asked = 0;
  const auto clearance = [&](const Vec2& at) {
    ++asked;
    return signed_distance(at, Shape{circle});
  };
  CHECK_FALSE(SweepByDistance(Vec2(-1, 5), Vec2(1, 5), 0.5, clearance).touches());
  CHECK(asked == 1);
  asked = 0;
  CHECK_FALSE(SweepByDistance(Vec2(-4, 1.51), Vec2(4, 1.51), 0.5, clearance).touches());
  CHECK(asked < 100);
  asked = 0;
  CHECK_FALSE(SweepByDistance(Vec2(-4, 1.500002), Vec2(4, 1.500002), 0.5, clearance).touches());
  CHECK(asked < 10'000);
}

TEST_CASE("a NaN clearance counts as contact") {
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinite = std::numeric_limits<double>::infinity();
  CHECK(SweepByDistance(Vec2(0, 0), Vec2(1, 0), 0, [&](const Vec2&) { return nan; }).touches());
  CHECK_FALSE(SweepByDistance(Vec2(0, 0), Vec2(1, 0), 0, [&](const Vec2&) { return infinite; }).touches());
}

TEST_CASE("invalid sweeps are rejected") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto far = [](const Vec2&) { return 1.0; };
  CHECK_THROWS_AS(SweepByDistance(Vec2(0, nan), Vec2(1, 0), 0, far), std::invalid_argument);
  CHECK_THROWS_AS(SweepByDistance(Vec2(0, 0), Vec2(1, 0), -1, far), std::invalid_argument);
  CHECK_THROWS_AS(SweepByDistance(Vec2(0, 0), Vec2(1, 0), nan, far), std::invalid_argument);
  CHECK_THROWS_AS(SweepByDistance(Vec2(0, 0), Vec2(1, 0), 0, far, 0), std::invalid_argument);
}

}  // namespace sidestep::sweep_by_distance_test
