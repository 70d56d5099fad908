// SPDX-License-Identifier: Apache-2.0
#include "tests/catch.hpp"
#include "tests/unit/agents/planning/grids/navigation/random_grid.hpp"

namespace sidestep::replanning_test {

/// Blocks, frees or reweights a few cells: a wall, a patch, or single cells.
void change_costs(Rng& rng, CostGrid& grid, EStar& field) {
  const GridLayout& layout = grid.layout();
  const auto column = static_cast<std::uint32_t>(rng.below(layout.columns));
  const auto row = static_cast<std::uint32_t>(rng.below(layout.rows));
  const auto width = static_cast<std::uint32_t>(1 + rng.below(12)), height = 1 + 12 / width;
  const auto kind = rng.below(4);
  for (std::uint32_t y = row; y < std::min(row + height, layout.rows); ++y) {
    for (std::uint32_t x = column; x < std::min(column + width, layout.columns); ++x) {
      const GridCell cell = layout.cell(x, y);
      const float cost = kind == 0   ? kBlocked
                         : kind == 1 ? 1
                         : kind == 2 ? static_cast<float>(rng.uniform(1, 20))
                                     : (rng.chance(0.5) ? kBlocked : 1);
      grid.set_cost(cell, cost);
      field.set_cost(cell, cost);
    }
  }
}

TEST_CASE("a replanned field is bit-identical to a field computed from scratch") {
  const auto kernel = GENERATE(GridKernel::kNf1, GridKernel::kAlpha, GridKernel::kLsm,
                               GridKernel::kSecondOrderLsm, GridKernel::kLineOfSight);
  const auto exact_radius_cells = GENERATE(0, 4, 20);
  const bool has_radius = kernel == GridKernel::kLsm || kernel == GridKernel::kSecondOrderLsm;
  if (exact_radius_cells > 0 && !has_radius) return;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(kernel, exact_radius_cells, seed);
    Rng rng(seed);
    const auto columns = static_cast<std::uint32_t>(2 + rng.below(60));
    const auto rows = static_cast<std::uint32_t>(2 + rng.below(60));
    CostGrid grid = random_grid(rng, columns, rows, seed % 4 == 0 ? 0 : 0.25);
    const EStarSettings settings{.kernel = kernel, .exact_radius_cells = exact_radius_cells};
    const Vec2 goal = random_position(rng, grid.layout());
    EStar field = propagated(grid, goal, settings);
    for (int change = 0; change < 25; ++change) {
      CAPTURE(change);
      for (auto n = 1 + rng.below(3); n > 0; --n) change_costs(rng, grid, field);
      field.propagate();
      REQUIRE(count_differences(field, propagated(grid, goal, settings)) == 0);
    }
  }
}

TEST_CASE("a partly propagated field is correct up to the requested cell after each change of costs") {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    CostGrid grid = random_grid(rng, 50, 40, 0.2);
    const Vec2 goal = random_position(rng, grid.layout());
    EStar field(grid);
    field.set_goal(goal);
    for (int change = 0; change < 20; ++change) {
      CAPTURE(change);
      const auto cell = static_cast<GridCell>(rng.below(grid.layout().size()));
      field.propagate_until(cell);
      const EStar fresh = propagated(grid, goal);
      for (GridCell other = 0; other < grid.layout().size(); ++other)
        if (fresh.value(other) <= fresh.value(cell)) REQUIRE(field.value(other) == fresh.value(other));
      change_costs(rng, grid, field);
    }
    field.propagate();
    REQUIRE(count_differences(field, propagated(grid, goal)) == 0);
  }
}

TEST_CASE("a field is propagated only as far as the robot") {
  const CostGrid grid({.columns = 200, .rows = 200});
  EStar field(grid);
  field.set_goal(grid.layout().centre_of(grid.layout().cell(20, 20)));
  const GridCell near = grid.layout().cell(60, 20);
  field.propagate_until(near);
  const std::uint64_t first = field.expansions();
  CHECK(field.value(near) == Approx(40).epsilon(0.01));
  CHECK(first < 6'000);  // a disc with a radius of 40 cells, cut off 20 cells from its centre on two sides
  field.propagate_until(near);
  CHECK(field.expansions() == first);
  field.propagate();
  CHECK(field.expansions() >= 200 * 200);
}

TEST_CASE("replanning expands few cells other than those whose values change") {
  for (const bool far : {false, true}) {
    const CostGrid grid({.columns = 200, .rows = 200});
    const GridLayout& layout = grid.layout();
    EStar field = propagated(grid, layout.centre_of(layout.cell(30, 100)));
    const EStar before = field;
    const std::uint32_t column = far ? 180 : 60;
    for (std::uint32_t row = 95; row < 105; ++row) field.set_cost(layout.cell(column, row), kBlocked);
    std::uint64_t expansions = field.expansions();
    field.propagate();
    const std::size_t changed = count_differences(field, before);
    CHECK(changed > 10);
    CHECK(field.expansions() - expansions < changed * 5 / 2);
    for (std::uint32_t row = 95; row < 105; ++row) field.set_cost(layout.cell(column, row), 1);
    expansions = field.expansions();
    field.propagate();
    CHECK(field.expansions() - expansions < changed * 3 / 2);
    CHECK(count_differences(field, before) == 0);
  }
}

TEST_CASE("a new goal starts a new field") {
  Rng rng(3);
  CostGrid grid = random_grid(rng, 40, 30, 0.2);
  EStar field = propagated(grid, random_position(rng, grid.layout()));
  change_costs(rng, grid, field);
  const Vec2 goal = random_position(rng, grid.layout());
  field.set_goal(goal);
  field.propagate();
  CHECK(count_differences(field, propagated(grid, goal)) == 0);
}

TEST_CASE("E* rejects invalid input") {
  const CostGrid grid({.columns = 5, .rows = 4});
  EStar field(grid);
  CHECK_THROWS_AS(field.propagate(), std::invalid_argument);
  CHECK_THROWS_AS(field.set_goal({0.6, 0.1}), std::invalid_argument);
  CHECK_THROWS_AS(field.set_goal({std::nan(""), 0.1}), std::invalid_argument);
  CHECK_THROWS_AS(field.set_cost(20, 1), std::invalid_argument);
  CHECK_THROWS_AS(field.set_cost(3, 0.5f), std::invalid_argument);
  CHECK_THROWS_AS(field.set_cost(3, std::nanf("")), std::invalid_argument);
  CHECK_THROWS_AS(EStar(grid, {.exact_radius_cells = 21}), std::invalid_argument);
  CHECK_THROWS_AS(CostGrid({.columns = 0, .rows = 4}), std::invalid_argument);
  CHECK_THROWS_AS(CostGrid({.columns = 3, .rows = 4, .resolution_m = 0}), std::invalid_argument);
}

TEST_CASE("a blocked goal is unreachable until it is freed") {
  CostGrid grid({.columns = 30, .rows = 30});
  const GridCell goal = grid.layout().cell(10, 12);
  grid.block(goal);
  EStar field = propagated(grid, grid.layout().centre_of(goal));
  for (GridCell cell = 0; cell < grid.layout().size(); ++cell) REQUIRE(field.value(cell) == kBlocked);
  field.set_cost(goal, 1);
  field.propagate();
  CHECK(field.value(grid.layout().cell(29, 12)) == Approx(19).epsilon(0.01));
}

}  // namespace sidestep::replanning_test
