// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/navigation/descent.hpp"

#include "common/geometry/box.hpp"
#include "tests/catch.hpp"
#include "tests/unit/agents/planning/grids/navigation/random_grid.hpp"

namespace sidestep::descent_test {

/// Whether a segment crosses the interior of a blocked cell, found by checking all blocked cells.
bool crosses_blocked(const CostGrid& grid, const Vec2& from_m, const Vec2& to_m) {
  const GridLayout& layout = grid.layout();
  for (GridCell cell = 0; cell < layout.size(); ++cell) {
    if (!grid.is_blocked(cell)) continue;
    // Clips the segment to a slightly smaller cell (Liang, Barsky 1984).
    const Vec2 half = Vec2(0.5, 0.5) * layout.resolution_m * (1 - 1e-6), along = to_m - from_m;
    const Vec2 low = layout.centre_of(cell) - half - from_m, high = layout.centre_of(cell) + half - from_m;
    double enter = 0, leave = 1;
    for (int axis = 0; axis < 2; ++axis) {
      if (along[axis] == 0) {
        if (low[axis] > 0 || high[axis] < 0) leave = -1;
        continue;
      }
      const double a = low[axis] / along[axis], b = high[axis] / along[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (enter < leave) return true;
  }
  return false;
}

double length_of(const std::vector<Vec2>& path_m) {
  double length_m = 0;
  for (std::size_t i = 1; i < path_m.size(); ++i) length_m += (path_m[i] - path_m[i - 1]).norm();
  return length_m;
}

TEST_CASE("traced paths end at the goal and cross no obstacle") {
  const auto kernel =
      GENERATE(GridKernel::kNf1, GridKernel::kAlpha, GridKernel::kLsm, GridKernel::kSecondOrderLsm);
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    Rng rng(seed);
    const CostGrid grid = random_grid(rng, 40, 30, 0.1 * static_cast<double>(seed % 5));
    const Vec2 goal = random_position(rng, grid.layout());
    const EStar field = propagated(grid, goal, {.kernel = kernel});
    std::vector<Vec2> path;
    for (int i = 0; i < 20; ++i) {
      const Vec2 from = random_position(rng, grid.layout());
      CAPTURE(kernel, seed, i, from.transpose(), goal.transpose());
      const GridCell cell = *grid.layout().cell_at(from);
      const bool arrives = trace(field, from, path);
      REQUIRE(arrives == (!grid.is_blocked(cell) && field.value(cell) < kBlocked));
      REQUIRE(path.empty() == !arrives);
      if (!arrives) continue;
      REQUIRE(path.front() == from);
      REQUIRE(path.back() == goal);
      REQUIRE(path.size() < 2'000);
      for (std::size_t k = 1; k < path.size(); ++k)
        REQUIRE_FALSE(crosses_blocked(grid, path[k - 1], path[k]));
    }
  }
}

TEST_CASE("on a free floor, a fast-marching path is nearly straight") {
  const CostGrid grid({.columns = 120, .rows = 120, .resolution_m = 0.05});
  const Vec2 goal(1.03, 2.22);
  const EStar field = propagated(grid, goal);
  std::vector<Vec2> path;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Rng rng(seed);
    const Vec2 from = random_position(rng, grid.layout());
    CAPTURE(seed, from.transpose());
    REQUIRE(trace(field, from, path));
    CHECK(length_of(path) <= (goal - from).norm() * 1.01 + 0.01);
    const Vec2 along = direction_at(field, from), straight = (goal - from).normalized();
    CHECK(along.norm() == Approx(1));
    CHECK(along.dot(straight) > 0.98);
  }
}

TEST_CASE("paths avoid expensive regions if the way around is cheaper") {
  CostGrid grid({.columns = 60, .rows = 60});
  for (std::uint32_t row = 20; row < 40; ++row)
    for (std::uint32_t column = 20; column < 40; ++column) grid.set_cost(grid.layout().cell(column, row), 10);
  const EStar field = propagated(grid, {5.05, 3.05});
  std::vector<Vec2> path;
  REQUIRE(trace(field, {1.05, 3.05}, path));
  for (const Vec2& at : path) REQUIRE(signed_distance(at, Box{{2, 2}, {4, 4}}) > -0.05);
}

TEST_CASE("where the goal is unreachable, there is no direction and no path") {
  CostGrid grid({.columns = 10, .rows = 10});
  for (std::uint32_t row = 0; row < 10; ++row) grid.block(grid.layout().cell(5, row));
  const EStar field = propagated(grid, {0.85, 0.5});
  std::vector<Vec2> path{{1, 1}};
  for (const Vec2& from : {Vec2(0.2, 0.5), Vec2(0.55, 0.5), Vec2(-1, 0.5), Vec2(std::nan(""), 0.5)}) {
    CHECK_FALSE(trace(field, from, path));
    CHECK(path.empty());
    CHECK(direction_at(field, from) == Vec2(0, 0));
  }
  REQUIRE(trace(field, {0.85, 0.5}, path));
  CHECK(direction_at(field, {0.85, 0.5}) == Vec2(0, 0));
}

TEST_CASE("a path does not squeeze between two blocked cells that touch at a corner") {
  // . . . .
  // . # G .    The only way from S leads around.
  // . S # .
  // . . . .
  CostGrid grid({.columns = 4, .rows = 4, .resolution_m = 1});
  grid.block(grid.layout().cell(1, 2));
  grid.block(grid.layout().cell(2, 1));
  const EStar field = propagated(grid, {2.5, 2.5});
  std::vector<Vec2> path;
  REQUIRE(trace(field, {1.5, 1.5}, path));
  CHECK(length_of(path) > 3.4);
}

}  // namespace sidestep::descent_test
