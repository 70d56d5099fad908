// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/navigation/obstacle_cells.hpp"

#include <algorithm>

#include "agents/planning/grids/navigation/blocked_cells.hpp"
#include "tests/catch.hpp"
#include "tests/unit/agents/planning/grids/navigation/random_shape.hpp"

namespace sidestep::obstacle_cells_test {

const GridLayout kLayout{.columns = 30, .rows = 20, .resolution_m = 0.1};

/// Adds, moves and removes a few obstacles.
void change(ObstacleWorld& world, Rng& rng) {
  for (std::uint64_t i = rng.below(4); i > 0; --i) {
    const auto kind = rng.below(3);
    if (kind == 0 || world.size() == 0) {
      world.add(random_shape(rng));
      continue;
    }
    const ObstacleId id = world.obstacle(rng.below(world.size()));
    const double y = rng.uniform(-0.3, 0.3), x = rng.uniform(-0.3, 0.3);
    if (kind == 1)
      world.move(id, {x, y});
    else
      world.remove(id);
  }
}

/// Slow reference: the cells that each obstacle blocks, from scratch.
CostGrid blocked_by(const ObstacleWorld& world, double radius_m) {
  CostGrid grid(kLayout);
  for (const ObstacleId id : world.obstacles()) block_shape(grid, world.shape(id), radius_m);
  return grid;
}

TEST_CASE("the blocked cells follow obstacles that appear, move and disappear, and a replaced world") {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const double radius_m = rng.uniform(0, 0.3);
    ObstacleCells cells(kLayout, radius_m);
    ObstacleWorld world, other({Circle{{1, 1}, 0.3}, Box{{2, 0.5}, {2.2, 1.5}}});
    CostGrid before(kLayout);
    for (int i = 0; i < 30; ++i) {
      CAPTURE(i);
      if (rng.chance(0.1)) std::swap(world, other);
      change(world, rng);
      cells.update(world);
      const CostGrid expected = blocked_by(world, radius_m);
      const auto changed = cells.changed_cells();
      for (GridCell cell = 0; cell < kLayout.size(); ++cell) {
        REQUIRE(cells.is_blocked(cell) == expected.is_blocked(cell));
        if (expected.is_blocked(cell) != before.is_blocked(cell))
          REQUIRE(std::ranges::count(changed, cell) >= 1);
      }
      before = expected;
    }
  }
}

TEST_CASE("only cells of changed obstacles are visited") {
  ObstacleWorld world({Circle{{1, 1}, 0.3}, Circle{{2, 1}, 0.3}});
  ObstacleCells cells(kLayout, 0.1);
  cells.update(world);
  CHECK(cells.changed_bounds().size() == 2);
  cells.update(world);
  CHECK(cells.changed_cells().empty());
  CHECK(cells.changed_bounds().empty());
  world.move(ObstacleId{1}, {0.2, 0});
  cells.update(world);
  REQUIRE(cells.changed_bounds().size() == 2);
  for (const Box& bounds_m : cells.changed_bounds()) CHECK(bounds_m.min_m.x() >= 1.7 - 1e-9);
  for (const GridCell cell : cells.changed_cells()) CHECK(kLayout.centre_of(cell).x() > 1.5);
}

TEST_CASE("every cell that a shape blocks is found once") {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const Shape shape = random_shape(rng);
    const double radius_m = rng.chance(0.2) ? 0 : rng.uniform(0, 0.4);
    CostGrid grid(kLayout);
    block_shape(grid, shape, radius_m);
    std::vector<GridCell> cells{7};
    find_blocked_cells(kLayout, shape, radius_m, cells);
    CHECK(std::ranges::is_sorted(cells, std::ranges::less_equal{}));
    for (GridCell cell = 0; cell < kLayout.size(); ++cell)
      REQUIRE(std::ranges::count(cells, cell) == grid.is_blocked(cell));
  }
}

TEST_CASE("obstacle cells require a valid layout and radius") {
  CHECK_THROWS_AS(ObstacleCells({.columns = 0, .rows = 3}, 0.1), std::invalid_argument);
  CHECK_THROWS_AS(ObstacleCells(kLayout, -0.1), std::invalid_argument);
  CHECK_THROWS_AS(ObstacleCells(kLayout, std::nan("")), std::invalid_argument);
}

}  // namespace sidestep::obstacle_cells_test
