// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/free_space.hpp"

#include "tests/catch.hpp"
#include "tests/unit/agents/navigation/dynamic_window/random_hull.hpp"

namespace sidestep::free_space_test {

TEST_CASE("a query finds the nearest obstacle point that is not masked") {
  ObstaclePoints points;
  int without = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const Vec2 robot = random_point(rng, 5), at = random_point(rng, 5);
    const double masked_m = rng.chance(0.5) ? 0 : rng.uniform(0, 8);
    std::vector<Vec2> all;
    const std::size_t count = rng.below(20);
    while (all.size() < count) all.push_back(random_point(rng, 5));
    if (rng.chance(0.2)) all.emplace_back(std::nan(""), 0);
    points.set(all, robot);
    const FreeDistance found = points(at, masked_m);
    double least = std::numeric_limits<double>::infinity();
    Vec2 nearest(0, 0);
    for (const Vec2& point : all) {
      if (!((point - robot).norm() >= masked_m) || !((point - at).norm() < least)) continue;
      least = (point - at).norm();
      nearest = point;
    }
    if (std::isinf(least)) {
      ++without;
      CHECK(std::isinf(found.distance_m));
      CHECK(found.away == Vec2(0, 0));
      continue;
    }
    CHECK(found.distance_m == Approx(least).margin(1e-5));
    CHECK((found.away - (at - nearest).normalized()).norm() < 1e-3);
  }
  CHECK(without > 0);
  CHECK(without < 150);
}

TEST_CASE("the direction away from an obstacle is the gradient of the distance function") {
  // The distance from a disc of radius 1 at the origin.
  const DistanceFunction field([](const Vec2& at) { return at.norm() - 1; });
  const FreeDistance found = field({3, 4}, 0);
  CHECK(found.distance_m == Approx(4));
  CHECK((found.away - Vec2(0.6, 0.8)).norm() < 1e-6);
  const DistanceFunction empty([](const Vec2&) { return std::numeric_limits<double>::infinity(); });
  CHECK(empty({0, 0}, 0).away == Vec2(0, 0));
}

}  // namespace sidestep::free_space_test
