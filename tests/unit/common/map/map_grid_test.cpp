// SPDX-License-Identifier: Apache-2.0
#include "common/map/map_grid.hpp"

#include <limits>

#include "tests/catch.hpp"
#include "tests/unit/common/map/random_map.hpp"

namespace sidestep::map_grid_test {

TEST_CASE("a point is in the cell whose borders surround it") {
  const std::uint64_t seed = GENERATE(range(1, 40));
  CAPTURE(seed);
  Rng rng(seed);
  const MapGrid grid = test::random_map(rng, 100).grid();
  for (int i = 0; i < 300; ++i) {
    const Vec2 p = test::random_map_position(rng, grid);
    CAPTURE(p.x(), p.y());
    const Cell cell = grid.cell_at(p);
    CHECK((cell.column >= 0 ? p.x() >= grid.x_m(cell.column) : p.x() < grid.x_m(0)));
    CHECK((cell.column < grid.columns ? p.x() < grid.x_m(cell.column + 1) : cell.column == grid.columns));
    CHECK((cell.row >= 0 ? p.y() >= grid.y_m(cell.row) : p.y() < grid.y_m(0)));
    CHECK((cell.row < grid.rows ? p.y() < grid.y_m(cell.row + 1) : cell.row == grid.rows));
  }
}

TEST_CASE("the cell of a distant point lies just outside the map on the side of the point") {
  const MapGrid grid{3, 2, 0.5, {1, 1}};
  const double infinite = std::numeric_limits<double>::infinity();
  CHECK(grid.cell_at({-1e300, infinite}) == Cell{-1, 2});
  CHECK(grid.cell_at({1e300, -infinite}) == Cell{3, -1});
}

TEST_CASE("the cells that meet a box are those whose closed squares intersect the box") {
  const std::uint64_t seed = GENERATE(range(1, 40));
  CAPTURE(seed);
  Rng rng(seed);
  const MapGrid grid = test::random_map(rng, 20).grid();
  for (int i = 0; i < 40; ++i) {
    const Vec2 a = test::random_map_position(rng, grid), b = test::random_map_position(rng, grid);
    const Box box = rng.chance(0.2) ? Box{a, a} : Box{a.cwiseMin(b), a.cwiseMax(b)};
    const CellRange range = grid.cells_intersecting(box);
    bool agrees = true;
    for (int row = 0; row < grid.rows; ++row) {
      for (int column = 0; column < grid.columns; ++column) {
        const bool is_in_range = column >= range.first.column && column <= range.last.column &&
                                 row >= range.first.row && row <= range.last.row;
        agrees = agrees && is_in_range == overlap(grid.box_of({column, row}), box);
      }
    }
    CAPTURE(box.min_m.x(), box.min_m.y(), box.max_m.x(), box.max_m.y());
    CHECK(agrees);
  }
}

TEST_CASE("map grids with values out of range are rejected") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_NOTHROW(check({16'384, 4'096, 0.05, {0, 0}}));
  CHECK_NOTHROW(check({1, 1, 0.001, {-1e6, 1e6}}));
  for (const MapGrid& grid :
       {MapGrid{0, 1, 0.05, {0, 0}}, MapGrid{1, -1, 0.05, {0, 0}}, MapGrid{16'385, 1, 0.05, {0, 0}},
        MapGrid{16'384, 4'097, 0.05, {0, 0}}, MapGrid{1, 1, 0.0009, {0, 0}}, MapGrid{1, 1, 10.1, {0, 0}},
        MapGrid{1, 1, nan, {0, 0}}, MapGrid{1, 1, 0.05, {nan, 0}}, MapGrid{1, 1, 0.05, {0, nan}},
        MapGrid{1, 1, 0.05, {0, 1.1e6}}}) {
    CAPTURE(grid.columns, grid.rows, grid.resolution_m, grid.origin_m.x(), grid.origin_m.y());
    CHECK_THROWS_AS(check(grid), std::invalid_argument);
  }
}

}  // namespace sidestep::map_grid_test
