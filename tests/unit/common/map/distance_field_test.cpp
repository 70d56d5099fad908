// SPDX-License-Identifier: Apache-2.0
#include "common/map/distance_field.hpp"

#include <limits>

#include "common/map/distance_transform.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/map/random_map.hpp"

namespace sidestep::distance_field_test {

/// Squared distances in cells as distance_transform() reports them; -1 for cells that it does not report.
std::vector<std::int32_t> transformed(const BitGrid& bits) {
  const auto columns = static_cast<std::size_t>(bits.columns());
  std::vector<std::int32_t> squared(columns * static_cast<std::size_t>(bits.rows()), -1);
  distance_transform(bits, [&](int row, std::span<const std::int32_t> values) {
    REQUIRE(values.size() == columns);
    std::ranges::copy(values, squared.begin() + static_cast<std::ptrdiff_t>(columns) * row);
  });
  return squared;
}

std::int32_t brute_force_squared_cells(const BitGrid& bits, int column, int row) {
  std::int32_t nearest = kNoBlockedCell;
  for (int y = 0; y < bits.rows(); ++y)
    for (int x = 0; x < bits.columns(); ++x)
      if (bits.get(x, y)) nearest = std::min(nearest, (x - column) * (x - column) + (y - row) * (y - row));
  return nearest;
}

TEST_CASE("the distance transform equals a comparison of all pairs of cells") {
  const std::uint64_t seed = GENERATE(range(1, 150));
  CAPTURE(seed);
  Rng rng(seed);
  const OccupancyMap map = test::random_map(rng, 25);
  const BitGrid& bits = map.blocked();
  CAPTURE(bits.columns(), bits.rows());
  const std::vector<std::int32_t> squared = transformed(bits);
  const DistanceField field(map);
  std::size_t i = 0;
  for (int row = 0; row < bits.rows(); ++row) {
    for (int column = 0; column < bits.columns(); ++column, ++i) {
      const std::int32_t expected = brute_force_squared_cells(bits, column, row);
      if (squared[i] != expected) FAIL(column << ", " << row << ": " << squared[i] << ", not " << expected);
      const double distance = std::min(2047.0, std::sqrt(static_cast<double>(expected)));
      const double stored = field.centre_distance_cells({column, row});
      if (!(std::abs(stored - distance) < 1.0 / 50)) FAIL(stored << " instead of " << distance);
    }
  }
}

TEST_CASE("the distances in the largest map do not overflow") {
  constexpr int kSide = 16'384;
  for (const bool is_wide : {true, false}) {
    BitGrid bits(is_wide ? kSide : 4, is_wide ? 4 : kSide);
    bits.set(bits.columns() - 1, bits.rows() - 1);
    const std::vector<std::int32_t> squared = transformed(bits);
    CHECK(squared.front() == (kSide - 1) * (kSide - 1) + 9);
    CHECK(squared.back() == 0);
    const DistanceField field(OccupancyMap({bits.columns(), bits.rows(), 0.05, {0, 0}}, bits));
    CHECK(field.centre_distance_cells({0, 0}) == 2047);
  }
}

TEST_CASE("the distance field's lower bound never exceeds the exact distance and is close to it") {
  const std::uint64_t seed = GENERATE(range(1, 200));
  CAPTURE(seed);
  Rng rng(seed);
  const OccupancyMap map = test::random_map(rng, 100);
  const DistanceField field(map);
  for (int i = 0; i < 200; ++i) {
    const Vec2 p = test::random_map_position(rng, map.grid());
    const double distance_m = map.distance_m(p), bound_m = field.lower_bound_m(p);
    if (!(bound_m <= distance_m && bound_m >= 0 && bound_m >= distance_m - 1.5 * map.grid().resolution_m))
      FAIL("at " << p.x() << ", " << p.y() << ": bound " << bound_m << " for distance " << distance_m);
  }
}

TEST_CASE("a path that the distance field calls clear touches nothing") {
  const std::uint64_t seed = GENERATE(range(1, 100));
  CAPTURE(seed);
  Rng rng(seed);
  const OccupancyMap map = test::random_map(rng, 100);
  const DistanceField field(map);
  for (int i = 0; i < 200; ++i) {
    const Vec2 from = test::random_map_position(rng, map.grid());
    const Vec2 far = test::random_map_position(rng, map.grid());
    const Vec2 to = rng.chance(0.1) ? from : Vec2(from + rng.uniform() * (far - from));
    const double radius_m = rng.uniform(0, 3 * map.grid().resolution_m);
    CAPTURE(from.x(), from.y(), to.x(), to.y(), radius_m);
    const bool is_touching = map.touches(from, to, radius_m);
    if (field.is_clear(from, to, radius_m)) CHECK_FALSE(is_touching);
    CHECK(touches(map, field, from, to, radius_m) == is_touching);
  }
}

TEST_CASE("the distance field alone clears paths through open space") {
  const MapGrid grid{400, 400, 0.05, {0, 0}};
  BitGrid bits(400, 400);
  bits.set(200, 200);
  const DistanceField field(OccupancyMap(grid, bits));
  CHECK(field.is_clear({1, 1}, {19, 1}, 0.3));
  CHECK(field.is_clear({1, 1}, {19, 9}, 0.3));
  CHECK_FALSE(field.is_clear({1, 1}, {19, 19}, 0.3));
  CHECK_FALSE(field.is_clear({1, 1}, {19, 0.2}, 0.3));
}

TEST_CASE("the distance field never calls a path with invalid numbers clear") {
  const DistanceField field(OccupancyMap({9, 9, 1, {0, 0}}, BitGrid(9, 9)));
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = 1 / 0.0;
  CHECK(field.lower_bound_m({4.5, 4.5}) > 4);
  for (const double bad : {nan, infinite, -infinite, 1e300}) {
    CHECK(field.lower_bound_m({bad, 4}) == 0);
    CHECK(field.lower_bound_m({4, bad}) == 0);
    CHECK_FALSE(field.is_clear({4, 4}, {4, bad}, 0.1));
    CHECK_FALSE(field.is_clear({bad, 4}, {4, 4}, 0.1));
  }
  CHECK_FALSE(field.is_clear({4, 4}, {4, 4}, nan));
  CHECK_FALSE(field.is_clear({4, 4}, {4, 4}, -1));
}

}  // namespace sidestep::distance_field_test
