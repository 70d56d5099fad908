// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/domain/free_positions.hpp"

#include "agents/planning/domain/disc_domain.hpp"
#include "tests/catch.hpp"

namespace sidestep::free_positions_test {

constexpr double kRadius_m = 0.1;
const Field kField{6, 4};

ObstacleWorld random_world(Rng& rng) {
  std::vector<Shape> shapes;
  for (int i = 0; i < 25; ++i) {
    const double x = rng.uniform(-3, 3), y = rng.uniform(-2, 2), size_m = rng.uniform(0.05, 0.5);
    const Vec2 centre(x, y);
    if (rng.chance(0.5))
      shapes.emplace_back(Circle{centre, size_m});
    else
      shapes.emplace_back(Box{centre - Vec2(size_m, size_m / 2), centre + Vec2(size_m, size_m / 2)});
  }
  return ObstacleWorld(std::move(shapes));
}

Vec2 random_position(Rng& rng) {
  const double x = rng.uniform(-2.8, 2.8), y = rng.uniform(-1.8, 1.8);
  return {x, y};
}

TEST_CASE("the nearest free position is as near as the first of all free positions nearby") {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const ObstacleWorld world = random_world(rng);
    const Vec2 position = random_position(rng);
    const auto is_free = [&](const Vec2& p) {
      return kField.contains(p, kRadius_m) && !world.touches(p, kRadius_m);
    };
    const auto nearest = nearest_free_position(position, kRadius_m / 8, 8, is_free);
    const std::vector<Vec2> all = free_positions_near(position, kRadius_m / 8, 8, is_free);
    REQUIRE(nearest.has_value() == !all.empty());
    if (!nearest) continue;
    ++found;
    CHECK(is_free(*nearest));
    const double first_m = (all.front() - position).norm();
    CHECK(std::abs((*nearest - position).norm() - first_m) <= 0.02 * first_m + kRadius_m / 8);
  }
  CHECK(found > 150);
}

TEST_CASE(
    "a blocked start's exit is the nearest free position that a straight line out of the obstacles reaches") {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const ObstacleWorld world = random_world(rng);
    const Vec2 start = random_position(rng);
    const DiscDomain domain(world, kField, kRadius_m, start, start);
    if (!domain.start_is_blocked()) continue;
    const auto can_exit = [&](const Vec2& p) {
      return kField.contains(p, kRadius_m) && !world.touches(p, kRadius_m) && domain.check(start, p);
    };
    const std::optional<Vec2> exit = domain.exit();
    // Slow reference: follows rays in small steps.
    double reference_m = 1e9;
    for (int i = 0; i < 256; ++i)
      for (double d = 0.005; d < reference_m && d < 3; d += 0.005)
        if (can_exit(start + d * rotated(Vec2(1, 0), i * 2 * std::numbers::pi / 256)))
          reference_m = std::min(reference_m, d);
    if (!exit) continue;  // the search misses gaps narrower than its step
    ++found;
    CHECK(can_exit(*exit));
    CHECK((*exit - start).norm() >= 0.97 * reference_m - 0.005);
    if (reference_m < 1e9) CHECK((*exit - start).norm() <= 1.03 * reference_m + kRadius_m / 4);
  }
  CHECK(found > 60);
}

TEST_CASE("a domain without a goal permits the same motions as a domain with a goal") {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const ObstacleWorld world = random_world(rng);
    const Vec2 start = random_position(rng);
    const DiscDomain with_goal(world, kField, kRadius_m, start, random_position(rng));
    const DiscDomain for_checks(DiscDomain::WithoutGoal(), world, kField, kRadius_m, start);
    for (int i = 0; i < 50; ++i) {
      const Vec2 to = random_position(rng), other = random_position(rng);
      CHECK(for_checks.check(start, to) == with_goal.check(start, to));
      CHECK(for_checks.check(other, to) == with_goal.check(other, to));
    }
  }
}

}  // namespace sidestep::free_positions_test
