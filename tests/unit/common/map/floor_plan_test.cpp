// SPDX-License-Identifier: Apache-2.0
#include "common/map/floor_plan.hpp"

#include <limits>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::floor_plan_test {

/// The number of free cells connected with the first one through shared edges, and the number of free cells.
std::pair<int, int> count_reached_and_free(const OccupancyMap& map) {
  const MapGrid& grid = map.grid();
  BitGrid seen(grid.columns, grid.rows);
  std::vector<Cell> open;
  int free = 0, reached = 0;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      if (map.is_blocked({column, row})) continue;
      if (free++ == 0) open.push_back({column, row});
    }
  }
  for (const Cell& cell : open) seen.set(cell.column, cell.row);
  while (!open.empty()) {
    const Cell at = open.back();
    open.pop_back();
    ++reached;
    for (const Cell& next : {Cell{at.column + 1, at.row}, Cell{at.column - 1, at.row},
                             Cell{at.column, at.row + 1}, Cell{at.column, at.row - 1}}) {
      if (map.is_blocked(next) || seen.get(next.column, next.row)) continue;
      seen.set(next.column, next.row);
      open.push_back(next);
    }
  }
  return {reached, free};
}

TEST_CASE("all free cells of a floor plan are connected") {
  const std::uint64_t seed = GENERATE(range(1, 200));
  CAPTURE(seed);
  Rng rng(seed);
  MapGrid grid;
  grid.columns = 1 + static_cast<int>(rng.below(500));
  grid.rows = 1 + static_cast<int>(rng.below(500));
  FloorPlanSettings settings;
  const bool is_usual = rng.chance(0.5);
  if (!is_usual) {
    settings.min_room_m = rng.uniform(0.05, 3);
    settings.door_m = rng.uniform(0.04, settings.min_room_m);
    settings.max_room_m = settings.min_room_m * rng.uniform(1, 4);
    settings.wall_m = rng.uniform(0.05, 0.4);
    settings.corridor_m = rng.uniform(0.05, 2);
    settings.aisle_m = rng.uniform(0.05, 1);
  }
  CAPTURE(grid.columns, grid.rows, settings.min_room_m, settings.door_m, settings.wall_m);
  const auto [reached, free] = count_reached_and_free(make_floor_plan(seed, grid, settings));
  CHECK(reached == free);
  if (is_usual && std::min(grid.columns, grid.rows) > 30) CHECK(free > grid.columns * grid.rows / 10);
}

TEST_CASE("the same seed gives the same floor plan") {
  const MapGrid grid{300, 200, 0.05, {1, 2}};
  const OccupancyMap plan = make_floor_plan(7, grid);
  CHECK(plan.blocked() == make_floor_plan(7, grid).blocked());
  CHECK_FALSE(plan.blocked() == make_floor_plan(8, grid).blocked());
  CHECK(plan.extent().min_m == Vec2(1, 2));
}

TEST_CASE("invalid floor plan settings are rejected") {
  const MapGrid grid{300, 200, 0.05, {0, 0}};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refuse = [&](auto change) {
    FloorPlanSettings settings;
    change(settings);
    CHECK_THROWS_AS(make_floor_plan(1, grid, settings), std::invalid_argument);
  };
  refuse([](FloorPlanSettings& s) { s.wall_m = 0; });
  refuse([&](FloorPlanSettings& s) { s.aisle_m = nan; });
  refuse([](FloorPlanSettings& s) { s.shelf_m = 1e9; });
  refuse([](FloorPlanSettings& s) { s.door_m = 3.1; });
  refuse([](FloorPlanSettings& s) { s.max_room_m = 2; });
  refuse([](FloorPlanSettings& s) { s.corridor_chance = 1.5; });
  refuse([&](FloorPlanSettings& s) { s.shelves_chance = nan; });
  CHECK_THROWS_AS(make_floor_plan(1, MapGrid{0, 1, 1, {0, 0}}), std::invalid_argument);
}

}  // namespace sidestep::floor_plan_test
