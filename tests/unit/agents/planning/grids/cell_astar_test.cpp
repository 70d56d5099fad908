// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/cell_astar.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::cell_astar_test {

BitGrid grid_of(const std::vector<std::string>& rows) {
  BitGrid grid(static_cast<int>(rows[0].size()), static_cast<int>(rows.size()));
  for (int y = 0; y < grid.rows(); ++y)
    for (int x = 0; x < grid.columns(); ++x)
      if (rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] == '#') grid.set(x, y);
  return grid;
}

BitGrid random_grid(int columns, int rows, double share, Rng& rng) {
  BitGrid grid(columns, rows);
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x)
      if (rng.chance(share)) grid.set(x, y);
  return grid;
}

/// Slow reference: path lengths from the start by relaxing all steps until nothing changes (Bellman, Ford).
double shortest(const BitGrid& blocked, const Cell& start, const Cell& goal) {
  const int columns = blocked.columns(), rows = blocked.rows();
  const auto is_free = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < columns && y < rows &&
           (!blocked.get(x, y) || Cell{x, y} == start || Cell{x, y} == goal);
  };
  std::vector<double> length(static_cast<std::size_t>(columns * rows),
                             std::numeric_limits<double>::infinity());
  const auto at = [&](int x, int y) -> double& { return length[static_cast<std::size_t>(y * columns + x)]; };
  at(start.column, start.row) = 0;
  for (bool has_changed = true; has_changed;) {
    has_changed = false;
    for (int y = 0; y < rows; ++y) {
      for (int x = 0; x < columns; ++x) {
        if (!is_free(x, y)) continue;
        for (int k = 0; k < 9; ++k) {
          const int dx = k % 3 - 1, dy = k / 3 - 1;
          if (!is_free(x + dx, y + dy) || !is_free(x, y + dy) || !is_free(x + dx, y)) continue;
          const double through = at(x + dx, y + dy) + std::hypot(dx, dy);
          if (through >= at(x, y) - 1e-9) continue;
          at(x, y) = through;
          has_changed = true;
        }
      }
    }
  }
  return at(goal.column, goal.row);
}

TEST_CASE("with an admissible heuristic, A* finds the shortest path over cells in valid steps") {
  const CellHeuristic heuristic =
      GENERATE(CellHeuristic::kNone, CellHeuristic::kStraight, CellHeuristic::kOctile);
  CellAstar astar(heuristic);
  int found = 0, none = 0;
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    Rng rng(seed);
    const BitGrid blocked = random_grid(17, 13, rng.uniform(0.1, 0.4), rng);
    const Cell start{static_cast<int>(rng.below(17)), static_cast<int>(rng.below(13))};
    const Cell goal{static_cast<int>(rng.below(17)), static_cast<int>(rng.below(13))};
    const CellRoute& route = astar.search(blocked, start, goal);
    const double expected = shortest(blocked, start, goal);
    CAPTURE(seed, int(heuristic), expected);
    REQUIRE(route.cells.empty() == std::isinf(expected));
    if (route.cells.empty()) {
      ++none;
      continue;
    }
    ++found;
    REQUIRE(route.length_cells == Approx(expected).margin(1e-9));
    REQUIRE(route.cells.front() == start);
    REQUIRE(route.cells.back() == goal);
    for (std::size_t i = 1; i < route.cells.size(); ++i) {
      const Cell a = route.cells[i - 1], b = route.cells[i];
      REQUIRE(std::max(std::abs(a.column - b.column), std::abs(a.row - b.row)) == 1);
      for (const Cell& passed : {b, Cell{a.column, b.row}, Cell{b.column, a.row}})
        REQUIRE((!blocked.get(passed.column, passed.row) || passed == start || passed == goal));
    }
  }
  CHECK(found > 80);
  CHECK(none > 10);
}

TEST_CASE("the octile heuristic never exceeds the remaining path length, but Manhattan does") {
  // On a free grid, the octile heuristic is exact.
  const BitGrid free(9, 9);
  for (int x = 0; x < 9; ++x) {
    for (int y = 0; y < 9; ++y) {
      const double length = shortest(free, {0, 0}, {x, y});
      CHECK(CellAstar::estimate(CellHeuristic::kOctile, x, y) == Approx(length).margin(1e-9));
      CHECK(CellAstar::estimate(CellHeuristic::kStraight, x, y) <= length + 1e-9);
      CHECK((CellAstar::estimate(CellHeuristic::kManhattan, x, y) > length + 1e-9) == (x > 0 && y > 0));
    }
  }
}

TEST_CASE("with the Manhattan heuristic, A* returns paths longer than necessary") {
  CellAstar manhattan(CellHeuristic::kManhattan);
  int longer = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Rng rng(seed);
    const BitGrid blocked = random_grid(25, 19, 0.25, rng);
    const CellRoute& route = manhattan.search(blocked, {0, 0}, {24, 18});
    const double expected = shortest(blocked, {0, 0}, {24, 18});
    CAPTURE(seed);
    REQUIRE(route.cells.empty() == std::isinf(expected));
    if (route.cells.empty()) continue;
    REQUIRE(route.length_cells >= expected - 1e-9);
    longer += route.length_cells > expected + 1e-6;
  }
  CHECK(longer > 5);
}

TEST_CASE("a diagonal step does not cut the corner of a blocked cell") {
  const BitGrid blocked = grid_of({"..", ".#"});
  CellAstar astar;
  CHECK(astar.search(blocked, {1, 0}, {0, 1}).length_cells == Approx(2));
  const BitGrid wall = grid_of({".#", "#."});
  CHECK(astar.search(wall, {0, 0}, {1, 1}).cells.empty());
}

}  // namespace sidestep::cell_astar_test
