// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/navigation/nf1.hpp"
#include "tests/catch.hpp"
#include "tests/unit/agents/planning/grids/navigation/random_grid.hpp"

namespace sidestep::field_test {

/// Reference: sweeps over all cells in double precision until nothing changes.
std::vector<double> swept(const CostGrid& grid, GridCell goal, GridKernel kernel) {
  const GridLayout& layout = grid.layout();
  constexpr double kFar = std::numeric_limits<double>::infinity();
  std::vector<double> values(layout.size(), kFar);
  const auto at = [&](std::int64_t x, std::int64_t y) {
    const bool inside = x >= 0 && y >= 0 && x < layout.columns && y < layout.rows;
    return inside ? values[static_cast<std::size_t>(y * layout.columns + x)] : kFar;
  };
  const auto solve = [&](double a, double b, double c) {
    if (kernel == GridKernel::kNf1 || std::max(a, b) == kFar) return std::min(a, b) + c;
    const double low = std::min(a, b), high = std::max(a, b);
    if (high >= low + c) return low + c;
    if (kernel == GridKernel::kAlpha)
      return std::min(std::max(high, low + c * c * (1 + high - low) / (1 + c)), low + c);
    // (t - a)^2 + (t - b)^2 = c^2
    const double half = (a + b) / 2, product = (a * a + b * b - c * c) / 2;
    return half + std::sqrt(half * half - product);
  };
  if (!grid.is_blocked(goal)) values[goal] = 0;
  for (bool changes = true; changes;) {
    changes = false;
    for (std::int64_t y = 0; y < layout.rows; ++y) {
      for (std::int64_t x = 0; x < layout.columns; ++x) {
        const auto cell = static_cast<GridCell>(y * layout.columns + x);
        if (grid.is_blocked(cell) || cell == goal) continue;
        const double value = solve(std::min(at(x - 1, y), at(x + 1, y)), std::min(at(x, y - 1), at(x, y + 1)),
                                   static_cast<double>(grid.cost(cell)));
        changes = changes || !(value == values[cell] || std::abs(value - values[cell]) < 1e-9);
        values[cell] = value;
      }
    }
  }
  return values;
}

TEST_CASE("a field solves the kernel's equations") {
  const auto kernel = GENERATE(GridKernel::kNf1, GridKernel::kAlpha, GridKernel::kLsm);
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    CAPTURE(kernel, seed);
    Rng rng(seed);
    const CostGrid grid = random_grid(rng, 45, 35, 0.25);
    const auto goal = static_cast<GridCell>(rng.below(grid.layout().size()));
    const EStar field =
        propagated(grid, grid.layout().centre_of(goal), {.kernel = kernel, .exact_radius_cells = 0});
    const std::vector<double> reference = swept(grid, goal, kernel);
    for (GridCell cell = 0; cell < grid.layout().size(); ++cell) {
      CAPTURE(cell);
      if (std::isinf(reference[cell]))
        REQUIRE(std::isinf(field.value(cell)));
      else
        REQUIRE(field.value(cell) == Approx(reference[cell]).margin(1e-3));
    }
  }
}

TEST_CASE("the NF1 wavefront counts as many steps as E* with the NF1 kernel") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    CostGrid grid({.columns = 37, .rows = 23});
    for (GridCell cell = 0; cell < grid.layout().size(); ++cell)
      if (rng.chance(0.3)) grid.block(cell);
    const auto goal = static_cast<GridCell>(rng.below(grid.layout().size()));
    Nf1 wave;
    wave.propagate(grid, goal);
    const EStar field = propagated(grid, grid.layout().centre_of(goal), {.kernel = GridKernel::kNf1});
    for (GridCell cell = 0; cell < grid.layout().size(); ++cell) {
      const float steps = field.value(cell);
      REQUIRE(wave.steps(cell) ==
              (std::isinf(steps) ? Nf1::kUnreachable : static_cast<std::uint32_t>(steps)));
    }
  }
  Nf1 wave;
  CHECK_THROWS_AS(wave.propagate(CostGrid({.columns = 3, .rows = 3}), 9), std::invalid_argument);
}

TEST_CASE("cells near the goal and in its line of sight have exact distances") {
  // . . # .    The goal sees past corners, not through walls: the wall's right side is in its shadow.
  // . . # .
  // G . # .
  CostGrid grid({.columns = 41, .rows = 41, .resolution_m = 0.2});
  const GridLayout& layout = grid.layout();
  for (std::uint32_t row = 0; row < 15; ++row) grid.block(layout.cell(10, row));
  const Vec2 goal = layout.centre_of(layout.cell(2, 3)) + Vec2(0.05, -0.03);
  const EStar field = propagated(grid, goal, {.exact_radius_cells = 20});
  for (GridCell cell = 0; cell < layout.size(); ++cell) {
    const double distance = (layout.centre_of(cell) - goal).norm() / layout.resolution_m;
    const Vec2 at = layout.in_cells(layout.centre_of(cell)), from = layout.in_cells(goal);
    // The points where the line of sight from the goal crosses the wall's sides, at x = 10 and x = 11.
    const auto height_at = [&](double x) {
      return from.y() + (at.y() - from.y()) * (x - from.x()) / (at.x() - from.x());
    };
    const bool is_hidden = at.x() > 10 && std::min(height_at(10), height_at(11)) < 15 - 1e-9;
    CAPTURE(cell, distance, is_hidden);
    if (grid.is_blocked(cell)) continue;
    if (distance <= 20 && !is_hidden)
      REQUIRE(field.value(cell) == Approx(distance));
    else if (is_hidden)
      REQUIRE(field.value(cell) > distance + 1e-3);
  }
}

TEST_CASE("exact distances do not extend across regions with a different cost") {
  CostGrid grid({.columns = 30, .rows = 9});
  const GridLayout& layout = grid.layout();
  for (std::uint32_t row = 0; row < 9; ++row) grid.set_cost(layout.cell(10, row), 7);
  const EStar field = propagated(grid, layout.centre_of(layout.cell(4, 4)));
  CHECK(field.value(layout.cell(9, 4)) == 5);
  CHECK(field.value(layout.cell(10, 4)) == Approx(12).epsilon(0.01));
  CHECK(field.value(layout.cell(11, 4)) == Approx(13).epsilon(0.01));
}

}  // namespace sidestep::field_test
