// SPDX-License-Identifier: Apache-2.0
#include "common/map/occupancy_map.hpp"

#include <limits>

#include "tests/catch.hpp"
#include "tests/unit/common/map/random_map.hpp"

namespace sidestep::occupancy_map_test {

constexpr double kTolerance_m = 1e-9;
const double kNan = std::numeric_limits<double>::quiet_NaN();

/// The distance from a point inside the map to the outside; negative for a point outside it.
double distance_to_outside(const Vec2& p, const Box& map) {
  return std::min((p - map.min_m).minCoeff(), (map.max_m - p).minCoeff());
}

/// The distance from a point to the map, computed from every blocked cell and the outside.
double brute_force_distance_m(const Vec2& p, const OccupancyMap& map) {
  double nearest_m = std::max(0.0, distance_to_outside(p, map.extent()));
  for (const Box& box : test::blocked_boxes(map))
    nearest_m = std::min(nearest_m, test::distance_to_box(p, box));
  return nearest_m;
}

/// The distance from a path to a box, by ternary search: the distance is a convex function of the position.
double brute_force_distance_m(const Vec2& from, const Vec2& to, const Box& box) {
  double low = 0, high = 1;
  const auto at = [&](double part) { return test::distance_to_box(from + part * (to - from), box); };
  for (int i = 0; i < 70; ++i) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    if (at(a) < at(b))
      high = b;
    else
      low = a;
  }
  return std::min({at(low), at(0), at(1)});
}

double brute_force_distance_m(const Vec2& from, const Vec2& to, const OccupancyMap& map) {
  double nearest_m = std::min(distance_to_outside(from, map.extent()), distance_to_outside(to, map.extent()));
  for (const Box& box : test::blocked_boxes(map)) {
    // No point of the path is nearer than its middle by more than half the path's length.
    const double bound_m = test::distance_to_box((from + to) / 2, box) - (to - from).norm() / 2;
    if (bound_m <= nearest_m + kTolerance_m)
      nearest_m = std::min(nearest_m, brute_force_distance_m(from, to, box));
  }
  return nearest_m;
}

/// A map with cells of 1 m, starting at the origin. '#' is a blocked cell; the first line is the top row.
OccupancyMap drawn(const std::vector<std::string>& rows) {
  BitGrid bits(static_cast<int>(rows[0].size()), static_cast<int>(rows.size()));
  for (int row = 0; row < bits.rows(); ++row)
    for (int column = 0; column < bits.columns(); ++column)
      if (rows[rows.size() - 1 - static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] == '#')
        bits.set(column, row);
  return {MapGrid{bits.columns(), bits.rows(), 1, {0, 0}}, bits};
}

TEST_CASE("cells keep their positions, and everything outside is blocked") {
  const OccupancyMap map = drawn({"..#",  //
                                  "#.."});
  CHECK(map.is_blocked({0, 0}));
  CHECK_FALSE(map.is_blocked({1, 0}));
  CHECK_FALSE(map.is_blocked({0, 1}));
  CHECK(map.is_blocked({2, 1}));
  for (const Cell& outside : {Cell{-1, 0}, Cell{3, 0}, Cell{1, -1}, Cell{1, 2}})
    CHECK(map.is_blocked(outside));
  CHECK(map.extent().max_m == Vec2(3, 2));
  CHECK(map.box_of({2, 1}).min_m == Vec2(2, 1));
  CHECK(map.cell_at({1.5, 0.5}) == Cell{1, 0});
}

TEST_CASE("the distance to a map is the distance to its nearest blocked cell") {
  const std::uint64_t seed = GENERATE(range(1, 120));
  CAPTURE(seed);
  Rng rng(seed);
  const OccupancyMap map = test::random_map(rng, 60);
  for (int i = 0; i < 40; ++i) {
    const Vec2 p = test::random_map_position(rng, map.grid());
    CAPTURE(p.x(), p.y());
    const double expected_m = brute_force_distance_m(p, map),
                 max_m = rng.uniform(0, 5 * map.grid().resolution_m);
    CHECK(map.distance_m(p) == Approx(expected_m).margin(kTolerance_m));
    CHECK(map.distance_m(p, max_m) == Approx(std::min(max_m, expected_m)).margin(kTolerance_m));
    CHECK(map.distance_m(p, 0) == 0);
  }
}

TEST_CASE("a moving disc touches every cell that it comes near enough to") {
  const std::uint64_t seed = GENERATE(range(1, 60));
  CAPTURE(seed);
  Rng rng(seed);
  const OccupancyMap map = test::random_map(rng, 14);
  int touching = 0;
  for (int i = 0; i < 60; ++i) {
    const Vec2 from = test::random_map_position(rng, map.grid());
    Vec2 to = rng.chance(0.1) ? from : test::random_map_position(rng, map.grid());
    if (rng.chance(0.7)) to = from + rng.uniform(0, 0.2) * (to - from);
    if (rng.chance(0.1)) to.y() = from.y();
    const double distance_m = brute_force_distance_m(from, to, map);
    // Often very close to contact.
    const double radius_m = rng.chance(0.5) ? std::max(0.0, distance_m + rng.uniform(-3e-9, 3e-9))
                                            : rng.uniform(0, 2 * map.grid().resolution_m);
    CAPTURE(from.x(), from.y(), to.x(), to.y(), radius_m, distance_m);
    const bool touches = map.touches(from, to, radius_m);
    if (distance_m < radius_m - kTolerance_m) CHECK(touches);
    if (distance_m > radius_m + kTolerance_m) CHECK_FALSE(touches);
    touching += touches;
  }
  CHECK(touching > 0);
}

TEST_CASE("the boxes of a region cover exactly its blocked cells without overlap") {
  const std::uint64_t seed = GENERATE(range(1, 80));
  CAPTURE(seed);
  Rng rng(seed);
  const OccupancyMap map = test::random_map(rng, 16);
  const MapGrid& grid = map.grid();
  for (int i = 0; i < 10; ++i) {
    const Vec2 a = test::random_map_position(rng, grid), b = test::random_map_position(rng, grid);
    const Box region{a.cwiseMin(b), a.cwiseMax(b)};
    CAPTURE(region.min_m.x(), region.min_m.y(), region.max_m.x(), region.max_m.y());
    std::vector<Box> inside;
    std::vector<Box> outside;
    CHECK(map.for_each_box(region, [&](const Box& box) {
      const Vec2 middle = (box.min_m + box.max_m) / 2;
      (distance_to_outside(middle, map.extent()) > 0 ? inside : outside).push_back(box);
      return true;
    }));
    for (int row = 0; row < grid.rows; ++row) {
      for (int column = 0; column < grid.columns; ++column) {
        const Box cell = grid.box_of({column, row});
        const Vec2 middle = (cell.min_m + cell.max_m) / 2;
        const auto covers = std::count_if(inside.begin(), inside.end(), [&](const Box& box) {
          return test::distance_to_box(middle, box) == 0;
        });
        const bool is_expected = map.is_blocked({column, row}) && overlap(cell, region);
        if (covers != (is_expected ? 1 : 0)) FAIL("cell " << column << ", " << row << ", boxes: " << covers);
      }
    }
    // A point of the region lies in an outside box if and only if it is outside the map or on its border.
    for (int j = 0; j < 20; ++j) {
      const double x_m = rng.uniform(region.min_m.x(), region.max_m.x());
      const double y_m = rng.uniform(region.min_m.y(), region.max_m.y());
      const Vec2 p(rng.chance(0.3) ? region.min_m.x() : x_m, rng.chance(0.3) ? region.max_m.y() : y_m);
      const bool is_covered = std::any_of(outside.begin(), outside.end(),
                                          [&](const Box& box) { return test::distance_to_box(p, box) == 0; });
      CHECK(is_covered == (distance_to_outside(p, map.extent()) <= 0));
    }
  }
}

TEST_CASE("walls and solid areas are single boxes") {
  const OccupancyMap map = drawn({"##########",  //
                                  "#........#",  //
                                  "#..####..#",  //
                                  "#..####..#",  //
                                  "#..####..#",  //
                                  "#........#",  //
                                  "##########"});
  const auto count = [&](const Box& region) {
    int boxes = 0;
    CHECK(map.for_each_box(region, [&](const Box&) { return ++boxes > 0; }));
    return boxes;
  };
  CHECK(count({{0.5, 0.5}, {9.5, 6.5}}) == 5);
  CHECK(count({{3.5, 2.5}, {6.5, 4.5}}) == 1);
  CHECK(count({{1.5, 1.5}, {2.5, 1.5}}) == 0);
  CHECK(count({{1.5, 1.5}, {2.5, 2}}) == 0);
  CHECK(count({{1.5, 1.5}, {3, 2}}) == 1);
  CHECK(count({{0.5, 1.5}, {0.5, 5.5}}) == 1);
  CHECK(count({{-1, -1}, {11, 8}}) == 9);
  CHECK(count({{20, 1}, {21, 2}}) == 1);
}

TEST_CASE("listing boxes stops when the callback returns false") {
  const OccupancyMap map = drawn({"#.#",  //
                                  "...",  //
                                  "#.#"});
  int all = 0;
  const Box region{{-1, -1}, {4, 4}};
  CHECK(map.for_each_box(region, [&](const Box&) { return ++all > 0; }));
  CHECK(all == 8);
  for (int stop = 1; stop <= all; ++stop) {
    int calls = 0;
    CHECK_FALSE(map.for_each_box(region, [&](const Box&) { return ++calls < stop; }));
    CHECK(calls == stop);
  }
}

TEST_CASE("rectangles cover exactly the blocked cells and cannot be extended") {
  const std::uint64_t seed = GENERATE(range(1, 80));
  CAPTURE(seed);
  Rng rng(seed);
  const OccupancyMap map = test::random_map(rng, 40);
  const MapGrid& grid = map.grid();
  const auto boxes = map.rectangles(100'000);
  REQUIRE(boxes);
  BitGrid covered(grid.columns, grid.rows);
  for (const Box& box : *boxes) {
    const Vec2 inside(grid.resolution_m / 2, grid.resolution_m / 2);
    const Cell first = map.cell_at(box.min_m + inside), last = map.cell_at(box.max_m - inside);
    CHECK(overlap(map.box_of(first), box));
    const auto is_solid = [&](int column, int row, int last_column, int last_row) {
      for (int y = row; y <= last_row; ++y)
        for (int x = column; x <= last_column; ++x)
          if (!grid.has({x, y}) || !map.is_blocked({x, y})) return false;
      return true;
    };
    CHECK(is_solid(first.column, first.row, last.column, last.row));
    CHECK_FALSE(is_solid(first.column - 1, first.row, last.column, last.row));
    CHECK_FALSE(is_solid(first.column, first.row - 1, last.column, last.row));
    CHECK_FALSE(is_solid(first.column, first.row, last.column + 1, last.row));
    CHECK_FALSE(is_solid(first.column, first.row, last.column, last.row + 1));
    for (int row = first.row; row <= last.row; ++row) covered.set_run(first.column, last.column + 1, row);
  }
  CHECK(covered == map.blocked());
  CHECK(map.rectangles(boxes->size()));
  if (!boxes->empty()) CHECK_FALSE(map.rectangles(boxes->size() - 1));
}

TEST_CASE("simple maps are covered by few rectangles") {
  CHECK(drawn({"...", "..."}).rectangles(0)->empty());
  CHECK(drawn({"###", "###"}).rectangles(1)->size() == 1);
  const OccupancyMap room = drawn({"#####",  //
                                   "#...#",  //
                                   "#####"});
  CHECK(room.rectangles(4)->size() == 4);
  CHECK_FALSE(room.rectangles(3));
}

TEST_CASE("invalid maps and queries are rejected") {
  CHECK_THROWS_AS(OccupancyMap(MapGrid{2, 1, 0.05, {0, 0}}, BitGrid(1, 2)), std::invalid_argument);
  CHECK_THROWS_AS(OccupancyMap(MapGrid{1, 1, 0, {0, 0}}, BitGrid(1, 1)), std::invalid_argument);
  const OccupancyMap map = drawn({"..", ".."});
  CHECK_THROWS_AS(map.distance_m({kNan, 0}), std::invalid_argument);
  CHECK_THROWS_AS(map.distance_m({1, 1}, -1), std::invalid_argument);
  CHECK_THROWS_AS(map.distance_m({1, 1}, kNan), std::invalid_argument);
  CHECK_THROWS_AS(map.touches({1, kNan}, {1, 1}, 0), std::invalid_argument);
  CHECK_THROWS_AS(map.touches({1, 1}, {1, 1}, -1), std::invalid_argument);
  const auto all = [](const Box&) { return true; };
  CHECK_THROWS_AS(map.for_each_box({{0, kNan}, {1, 1}}, all), std::invalid_argument);
  CHECK_THROWS_AS(map.for_each_box({{2, 0}, {1, 1}}, all), std::invalid_argument);
}

}  // namespace sidestep::occupancy_map_test
