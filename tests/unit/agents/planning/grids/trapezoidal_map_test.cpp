// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/trapezoidal_map.hpp"

#include <algorithm>
#include <cmath>

#include "tests/catch.hpp"
#include "tests/unit/agents/planning/grids/random_segments.hpp"

namespace sidestep::trapezoidal_map_test {

using Index = TrapezoidalMap::Index;

/// Compares the heights of two segments at a point that lies within the extent of both: positive if a is
/// higher. Exact on small grids. If the segments meet on the vertical line through the point, that line is
/// sheared slightly: it then intersects them to the right of where they meet if they meet below the point,
/// otherwise to the left.
std::int64_t compare_heights(const GridSegment& a, const GridSegment& b, const GridPoint& at) {
  // y = numerator / width; on a vertical segment, y is that of the point.
  const auto y_of = [&](const GridSegment& s) {
    const std::int64_t width = s.right.x - s.left.x;
    if (width == 0) return std::pair(std::int64_t{at.y}, std::int64_t{1});
    return std::pair(s.left.y * width + (s.right.y - s.left.y) * (at.x - s.left.x), width);
  };
  const auto [a_numerator, a_width] = y_of(a);
  const auto [b_numerator, b_width] = y_of(b);
  if (a_numerator * b_width != b_numerator * a_width) return a_numerator * b_width - b_numerator * a_width;
  const std::int64_t steeper = (a.right.y - a.left.y) * b_width - (b.right.y - b.left.y) * a_width;
  return a_numerator < at.y * a_width ? steeper : -steeper;
}

/// The segments directly below and above a point that lies on no segment, found by comparing with all
/// segments.
std::pair<Index, Index> segments_around(const TrapezoidalMap& map, const GridPoint& p) {
  Index below = map.box_bottom(), above = map.box_top();
  for (Index i = 0; i + 2 < map.segments().size(); ++i) {
    const GridSegment& s = map.segments()[i];
    if (!(s.left <= p && p < s.right)) continue;
    if (height_above(s, p) > 0 && compare_heights(s, map.segments()[below], p) > 0) below = i;
    if (height_above(s, p) < 0 && compare_heights(map.segments()[above], s, p) > 0) above = i;
  }
  return {below, above};
}

double width_of(const TrapezoidalMap::Trapezoid& t) { return static_cast<double>(t.right.x - t.left.x); }

double area_of(const TrapezoidalMap& map, const TrapezoidalMap::Trapezoid& t) {
  const GridSegment &bottom = map.segments()[t.bottom], &top = map.segments()[t.top];
  const double left = y_at(top, t.left) - y_at(bottom, t.left);
  const double right = y_at(top, t.right) - y_at(bottom, t.right);
  return width_of(t) == 0 ? 0 : width_of(t) * (left + right) / 2;
}

/// Whether an end of a segment lies inside a trapezoid, which should then have been split.
bool contains_end(const TrapezoidalMap& map, const TrapezoidalMap::Trapezoid& t) {
  for (Index i = 0; i + 2 < map.segments().size(); ++i)
    for (const GridPoint& end : {map.segments()[i].left, map.segments()[i].right})
      if (t.left < end && end < t.right && height_above(map.segments()[t.bottom], end) > 0 &&
          height_above(map.segments()[t.top], end) < 0)
        return true;
  return false;
}

void check_map(const TrapezoidalMap& map, std::int32_t half) {
  std::size_t count = 0;
  double area = 0;
  for (Index i = 0; i < map.trapezoids().size(); ++i) {
    const TrapezoidalMap::Trapezoid& t = map.trapezoids()[i];
    if (t.leaf == TrapezoidalMap::kNone) continue;
    ++count;
    area += area_of(map, t);
    REQUIRE(t.left < t.right);
    REQUIRE_FALSE(contains_end(map, t));
    for (const std::size_t which : {0u, 1u}) {
      const Index right = t.right_neighbours[which];
      if (right == TrapezoidalMap::kNone) continue;
      const TrapezoidalMap::Trapezoid& other = map.trapezoids()[right];
      REQUIRE(other.leaf != TrapezoidalMap::kNone);
      REQUIRE(other.left == t.right);
      REQUIRE(other.left_neighbours[which] == i);
      REQUIRE((which == 0 ? other.bottom == t.bottom : other.top == t.top));
    }
    for (const std::size_t which : {0u, 1u}) {
      const Index left = t.left_neighbours[which];
      if (left != TrapezoidalMap::kNone) REQUIRE(map.trapezoids()[left].right_neighbours[which] == i);
    }
  }
  // De Berg et al. 2008, lemma 6.2.
  REQUIRE(count <= 3 * (map.segments().size() - 2) + 1);
  const auto side = static_cast<double>(2 * half);
  CHECK(area == Approx(side * side).epsilon(1e-12));
}

/// Number of trapezoids that share part of a trapezoid's right wall, by comparing with all trapezoids.
std::size_t count_right_neighbours(const TrapezoidalMap& map, const TrapezoidalMap::Trapezoid& t) {
  std::size_t count = 0;
  for (const TrapezoidalMap::Trapezoid& other : map.trapezoids()) {
    if (other.leaf == TrapezoidalMap::kNone || other.left != t.right) continue;
    const double low =
        std::max(y_at(map.segments()[t.bottom], t.right), y_at(map.segments()[other.bottom], t.right));
    const double high =
        std::min(y_at(map.segments()[t.top], t.right), y_at(map.segments()[other.top], t.right));
    count += high > low + 1e-9;
  }
  return count;
}

TEST_CASE("a trapezoidal map is consistent, and point location agrees with a comparison with all segments") {
  const std::uint64_t seed = GENERATE(range(1, 7));
  const std::size_t count = GENERATE(0, 1, 2, 10, 60);
  // On the smallest grid, most segments share ends or x coordinates with others.
  const std::int32_t half = GENERATE(4, 25, 900);
  CAPTURE(seed, count, half);
  Rng rng(seed);
  const std::vector<GridSegment> segments = random_divided_segments(rng, count, half, half);
  REQUIRE(segments.size() >= std::min<std::size_t>(count, 20));
  TrapezoidalMap map;
  map.build(segments, {half + 1, half + 1}, rng);
  check_map(map, half + 1);
  for (const TrapezoidalMap::Trapezoid& t : map.trapezoids()) {
    if (t.leaf == TrapezoidalMap::kNone) continue;
    const auto linked = static_cast<std::size_t>(
        2 - std::count(t.right_neighbours.begin(), t.right_neighbours.end(), TrapezoidalMap::kNone));
    REQUIRE(linked == count_right_neighbours(map, t));
  }
  int located = 0;
  for (int i = 0; i < 300; ++i) {
    const GridPoint p = random_grid_point(rng, half);
    CAPTURE(p.x, p.y);
    const auto is_on = [&](const GridSegment& s) {
      return s.left <= p && p <= s.right && height_above(s, p) == 0;
    };
    const TrapezoidalMap::Trapezoid& t = map.trapezoids()[map.locate(p).trapezoid];
    REQUIRE((t.left <= p && p <= t.right));
    REQUIRE(height_above(map.segments()[t.bottom], p) >= 0);
    REQUIRE(height_above(map.segments()[t.top], p) <= 0);
    if (std::any_of(segments.begin(), segments.end(), is_on)) continue;
    REQUIRE(std::pair(t.bottom, t.top) == segments_around(map, p));
    ++located;
  }
  CHECK((located > 100 || half == 4));
}

/// The trapezoids regardless of the order in which they are stored.
std::vector<std::array<std::int64_t, 6>> sorted_trapezoids(const TrapezoidalMap& map) {
  std::vector<std::array<std::int64_t, 6>> keys;
  for (const TrapezoidalMap::Trapezoid& t : map.trapezoids())
    if (t.leaf != TrapezoidalMap::kNone)
      keys.push_back({t.bottom, t.top, t.left.x, t.left.y, t.right.x, t.right.y});
  std::sort(keys.begin(), keys.end());
  return keys;
}

TEST_CASE("the trapezoids do not depend on the order of insertion") {
  const std::uint64_t seed = GENERATE(range(1, 6));
  CAPTURE(seed);
  Rng rng(seed);
  const std::vector<GridSegment> segments = random_divided_segments(rng, 50, 30, 20);
  TrapezoidalMap first, second;
  Rng order(1), other_order(2);
  first.build(segments, {40, 40}, order);
  second.build(segments, {40, 40}, other_order);
  REQUIRE(first.trapezoids()[0].left != second.trapezoids()[0].left);
  CHECK(sorted_trapezoids(first) == sorted_trapezoids(second));
  // The map can be rebuilt.
  const auto before = sorted_trapezoids(second);
  second.build(std::vector<GridSegment>{{{0, 0}, {1, 1}}}, {40, 40}, order);
  CHECK(sorted_trapezoids(second).size() == 4);
  second.build(segments, {40, 40}, order);
  CHECK(sorted_trapezoids(second) == before);
}

/// Horizontal segments, each above and beyond the previous one. Inserting them in this order gives a search
/// structure of linear depth.
std::vector<GridSegment> staircase(std::int32_t count) {
  std::vector<GridSegment> segments;
  for (std::int32_t i = 0; i < count; ++i) segments.push_back({{2 * i, i}, {2 * i + 1, i}});
  return segments;
}

double mean_steps(const TrapezoidalMap& map, const GridPoint& half, Rng& rng) {
  double steps = 0;
  constexpr int kPoints = 1000;
  for (int i = 0; i < kPoints; ++i) {
    const double y = rng.uniform(-half.y, half.y), x = rng.uniform(-half.x, half.x);
    steps +=
        static_cast<double>(map.locate({static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)}).steps);
  }
  return steps / kPoints;
}

TEST_CASE("locating a point takes a logarithmic number of steps for any segments") {
  const bool is_staircase = GENERATE(true, false);
  double steps_of_small_map = 0;
  for (const std::int32_t count : {64, 1024, 16384}) {
    // The expected number over the random orders: de Berg et al. 2008, theorem 6.3, with its constant.
    double mean = 0, slowest = 0;
    constexpr std::uint64_t kSeeds = 10;
    std::size_t size = 0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      Rng rng(seed);
      const std::vector<GridSegment> segments =
          is_staircase ? staircase(count)
                       : random_divided_segments(rng, static_cast<std::size_t>(count), 1 << 28, 1 << 20);
      size = segments.size();
      const GridPoint half = is_staircase ? GridPoint{2 * count, count} : GridPoint{1 << 29, 1 << 29};
      TrapezoidalMap map;
      map.build(segments, half, rng);
      const double steps = mean_steps(map, half, rng);
      mean += steps / kSeeds;
      slowest = std::max(slowest, steps);
    }
    CAPTURE(is_staircase, count, size, mean, slowest, steps_of_small_map);
    double harmonic = 0;
    for (std::size_t i = 1; i <= size; ++i) harmonic += 1 / static_cast<double>(i);
    CHECK(mean < 12 * harmonic);
    CHECK(mean > std::log2(static_cast<double>(size)) / 2);
    CHECK(slowest < 2 * mean);
    // With 16 times as many segments, the number of steps grows only by a constant.
    if (steps_of_small_map > 0) CHECK(mean < steps_of_small_map + 5 * std::log(16.0));
    steps_of_small_map = mean;
  }
}

TEST_CASE("a trapezoidal map rejects segments that it cannot represent") {
  TrapezoidalMap map;
  Rng rng(1);
  const auto build = [&](const std::vector<GridSegment>& segments) { map.build(segments, {10, 10}, rng); };
  CHECK_THROWS_AS(build({{{1, 1}, {0, 0}}}), std::invalid_argument);
  CHECK_THROWS_AS(build({{{0, 0}, {0, 0}}}), std::invalid_argument);
  CHECK_THROWS_AS(build({{{0, 0}, {10, 0}}}), std::invalid_argument);
  CHECK_THROWS_AS(build({{{0, 0}, {4, 0}}, {{0, 0}, {5, 0}}}), std::invalid_argument);
  CHECK_THROWS_AS(map.build({}, {kMaxGridCoordinate + 1, 10}, rng), std::invalid_argument);
  build({});
  CHECK(map.locate({0, 0}).steps == 0);
}

}  // namespace sidestep::trapezoidal_map_test
