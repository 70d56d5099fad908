// SPDX-License-Identifier: Apache-2.0
#include "common/map/ray_cast.hpp"

#include <numbers>

#include "tests/catch.hpp"
#include "tests/unit/common/collision/random_world.hpp"
#include "tests/unit/common/map/random_map.hpp"

namespace sidestep::ray_cast_test {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kTolerance_m = 1e-9;

/// The distance at which a ray enters a box, by intersecting the slabs of both axes; infinite if it misses.
double entry_m(const Vec2& from, const Vec2& direction, const Box& box) {
  double enters_m = 0, leaves_m = kInfinite;
  for (int axis = 0; axis < 2; ++axis) {
    const double low = box.min_m[axis] - from[axis], high = box.max_m[axis] - from[axis];
    if (direction[axis] == 0) {
      if (low > 0 || high < 0) return kInfinite;
      continue;
    }
    const double a = low / direction[axis], b = high / direction[axis];
    enters_m = std::max(enters_m, std::min(a, b));
    leaves_m = std::min(leaves_m, std::max(a, b));
  }
  return enters_m <= leaves_m ? enters_m : kInfinite;
}

/// The range of a ray, by checking every blocked cell and the outside, inflated by `inflation_m`.
double reference_range_m(const std::vector<Box>& cells, const Box& map, const Vec2& from,
                         const Vec2& direction, double inflation_m) {
  double nearest_m = kInfinite;
  for (const Box& cell : cells)
    nearest_m = std::min(nearest_m, entry_m(from, direction, inflated(cell, inflation_m)));
  // The outside of the map consists of four boxes larger than any map.
  const double far_m = 1e4;
  for (const Box& outside :
       {Box{{-far_m, -far_m}, {map.min_m.x(), far_m}}, Box{{map.max_m.x(), -far_m}, {far_m, far_m}},
        Box{{-far_m, -far_m}, {far_m, map.min_m.y()}}, Box{{-far_m, map.max_m.y()}, {far_m, far_m}}})
    nearest_m = std::min(nearest_m, entry_m(from, direction, inflated(outside, inflation_m)));
  return nearest_m;
}

Vec2 random_direction(Rng& rng) {
  if (rng.chance(0.3)) {
    constexpr double kDiagonal = 1 / std::numbers::sqrt2;
    const Vec2 directions[] = {
        {1, 0}, {-1, 0}, {0, 1}, {0, -1}, {kDiagonal, kDiagonal}, {-kDiagonal, kDiagonal}};
    return directions[rng.below(6)];
  }
  return rotated({1, 0}, rng.uniform(-4, 4));
}

TEST_CASE("a ray ends at the first blocked cell") {
  const std::uint64_t seed = GENERATE(range(1, 150));
  CAPTURE(seed);
  Rng rng(seed);
  const OccupancyMap map = test::random_map(rng, 60);
  const DistanceField field(map);
  const std::vector<Box> cells = test::blocked_boxes(map);
  for (int i = 0; i < 60; ++i) {
    const Vec2 from = test::random_map_position(rng, map.grid()), direction = random_direction(rng);
    CAPTURE(from.x(), from.y(), direction.x(), direction.y());
    const double longest_m = reference_range_m(cells, map.extent(), from, direction, -kTolerance_m);
    const double shortest_m = reference_range_m(cells, map.extent(), from, direction, kTolerance_m);
    const double found_m = cast_ray(map, field, from, direction, 1e4);
    if (!(found_m >= shortest_m - kTolerance_m && found_m <= longest_m + kTolerance_m))
      FAIL(found_m << " is not within " << shortest_m << " and " << longest_m);
    const double max_m = rng.uniform(0, 2) * found_m;
    const double limited_m = cast_ray(map, field, from, direction, max_m);
    CHECK(limited_m == (found_m <= max_m ? found_m : kInfinite));
  }
}

TEST_CASE("a ray does not slip between cells that touch at a corner") {
  BitGrid bits(4, 4);
  bits.set(2, 1);
  bits.set(1, 2);
  const OccupancyMap map({4, 4, 1, {0, 0}}, bits);
  const DistanceField field(map);
  const double diagonal = 1 / std::numbers::sqrt2;
  CHECK(cast_ray(map, field, {0.5, 0.5}, {diagonal, diagonal}, 10) == Approx(1.5 * std::numbers::sqrt2));
  CHECK(cast_ray(map, field, {3.5, 3.5}, {-diagonal, -diagonal}, 10) == Approx(1.5 * std::numbers::sqrt2));
}

TEST_CASE("a ray in a scene ends at the nearest map cell, shape or disc") {
  const std::uint64_t seed = GENERATE(range(1, 30));
  CAPTURE(seed);
  Rng rng(seed);
  const OccupancyMap map({200, 200, 0.05, {-5, -5}}, test::noise(rng, 200, 200, 0.001));
  const DistanceField field(map);
  const ObstacleWorld shapes(random_shapes(rng, 20, 5));
  std::vector<Circle> discs;
  for (int i = 0; i < 5; ++i) discs.push_back({random_position(rng, 5), 0.2});
  const ObstacleWorld disc_world({discs.begin(), discs.end()});
  for (int i = 0; i < 50; ++i) {
    const Vec2 from = random_position(rng, 5), direction = rotated({1, 0}, rng.uniform(-4, 4));
    const double max_m = rng.uniform(0, 12);
    const auto length_m = [&](const ObstacleWorld& world) {
      const auto contact = world.first_contact(from, from + max_m * direction, 0);
      return contact ? contact->fraction * max_m : kInfinite;
    };
    const double map_m = cast_ray(map, field, from, direction, max_m);
    CHECK(cast_ray(RayScene{&map, &field, nullptr, {}}, from, direction, max_m) == map_m);
    CHECK(cast_ray(RayScene{nullptr, nullptr, &shapes, {}}, from, direction, max_m) == length_m(shapes));
    CHECK(cast_ray(RayScene{nullptr, nullptr, nullptr, discs}, from, direction, max_m) ==
          length_m(disc_world));
    CHECK(cast_ray(RayScene{&map, &field, &shapes, discs}, from, direction, max_m) ==
          std::min({map_m, length_m(shapes), length_m(disc_world)}));
  }
}

TEST_CASE("invalid rays are rejected") {
  const OccupancyMap map({4, 4, 1, {0, 0}}, BitGrid(4, 4));
  const DistanceField field(map);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(cast_ray(map, field, {nan, 1}, {1, 0}, 1), std::invalid_argument);
  CHECK_THROWS_AS(cast_ray(map, field, {1, 1}, {1, 1}, 1), std::invalid_argument);
  CHECK_THROWS_AS(cast_ray(map, field, {1, 1}, {nan, 0}, 1), std::invalid_argument);
  CHECK_THROWS_AS(cast_ray(map, field, {1, 1}, {1, 0}, nan), std::invalid_argument);
  CHECK_THROWS_AS(cast_ray(RayScene{}, {1, nan}, {1, 0}, 1), std::invalid_argument);
}

}  // namespace sidestep::ray_cast_test
