// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/bubble_band/bubble_band.hpp"
#include "agents/navigation/dynamic_window/disc_window.hpp"
#include "agents/navigation/dynamic_window/dynamic_window.hpp"
#include "agents/navigation/local_driver.hpp"
#include "tests/catch.hpp"
#include "tests/counted_allocations.hpp"
#include "tests/unit/agents/navigation/dynamic_window/random_hull.hpp"

namespace sidestep::local_allocation_test {

/// Number of allocations in a hundred runs of `work`, after as many warm-up runs.
template <typename Work>
std::size_t allocations_after_warm_up(Work work) {
  for (int i = 0; i < 100; ++i) work();
  const std::size_t before = allocation_count();
  for (int i = 0; i < 100; ++i) work();
  return allocation_count() - before;
}

std::vector<Vec2> random_points(Rng& rng, std::size_t count) {
  std::vector<Vec2> points;
  while (points.size() < count) points.push_back(random_point(rng, 2));
  return points;
}

TEST_CASE("dynamic windows do not allocate memory after a warm-up") {
  Rng rng(1);
  const std::vector<Vec2> points = random_points(rng, 360);
  const ConvexPolygon hull{{{-0.01, -0.01}, {0.01, -0.01}, {0, 0.01}}};
  for (const CollisionMethod method : {CollisionMethod::kExact, CollisionMethod::kUniformTable}) {
    DynamicWindow window(DifferentialDrive{}, hull, {.padding_m = 0, .cell_m = 0.1, .method = method});
    CHECK(allocations_after_warm_up([&] {
            const Vec2 goal = random_point(rng, 2);
            const double left = rng.uniform(-0.5, 0.5), right = rng.uniform(-0.5, 0.5);
            window.choose({points, {left, right}, {goal, std::nullopt, 0.1}, 0.1, {}});
          }) == 0);
    DiscWindow disc(0.01, MotionLimits{}, {.cell_m = 0.1, .method = method});
    CHECK(allocations_after_warm_up([&] {
            const Vec2 velocity = random_point(rng, 1);
            disc.choose({points, velocity, {2, 2}, 0.1, {}});
          }) == 0);
  }
}

TEST_CASE("a bubble band does not allocate memory after a warm-up") {
  Rng rng(2);
  BubbleBand band(0.3);
  ObstaclePoints free;
  std::vector<Vec2> points = random_points(rng, 360);
  const std::vector<Vec2> path{{-2, 0}, {0, 1}, {2, 0}};
  CHECK(allocations_after_warm_up([&] {
          for (Vec2& point : points) point += random_point(rng, 0.01);
          free.set(points, {-2, 0});
          if (band.is_broken()) band.start(path, free);
          band.update({-2, 0}, free);
        }) == 0);
}

TEST_CASE("a local driver does not allocate memory after a warm-up") {
  Rng rng(3);
  LocalDriver local({.uses_band = true, .uses_window = true}, Field{6, 6}, 0.09, 0.1, MotionLimits{});
  const ObstacleWorld world({Box{{-0.2, 0.5}, {0.2, 1}}, Circle{{1, 0.2}, 0.2}});
  const std::vector<Vec2> path{{0, 1.3}, {2, 0}};
  std::vector<Circle> others{{{-1, -1}, 0.1}, {{0, 2}, 0.1}};
  CHECK(allocations_after_warm_up([&] {
          for (Circle& other : others) other.centre_m += random_point(rng, 0.01);
          const Vec2 velocity = random_point(rng, 0.5);
          (void)local.choose({{{-2, 0}, velocity}, path, &world, others, 0.03});
        }) == 0);
}

}  // namespace sidestep::local_allocation_test
