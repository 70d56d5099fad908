// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/winding_segments.hpp"

#include <cmath>

#include "tests/catch.hpp"
#include "tests/unit/agents/planning/grids/random_segments.hpp"

namespace sidestep::winding_segments_test {

bool is_on(const GridPoint& p, const GridSegment& s) {
  return height_above(s, p) == 0 && std::min(s.left.x, s.right.x) <= p.x && p.x <= s.right.x &&
         std::min(s.left.y, s.right.y) <= p.y && p.y <= std::max(s.left.y, s.right.y);
}

/// Whether two segments share any point other than ends.
bool overlap_or_cross(const GridSegment& a, const GridSegment& b) {
  const auto is_inner = [](const GridPoint& p, const GridSegment& s) {
    return p != s.left && p != s.right && is_on(p, s);
  };
  if (a == b || is_inner(a.left, b) || is_inner(a.right, b) || is_inner(b.left, a) || is_inner(b.right, a))
    return true;
  const auto side = [](std::int64_t value) { return value > 0 ? 1 : value < 0 ? -1 : 0; };
  return side(height_above(a, b.left)) * side(height_above(a, b.right)) < 0 &&
         side(height_above(b, a.left)) * side(height_above(b, a.right)) < 0;
}

double distance(const GridPoint& p, const GridPoint& a, const GridPoint& b) {
  const double x = b.x - a.x, y = b.y - a.y, px = p.x - a.x, py = p.y - a.y;
  const double along = std::clamp((px * x + py * y) / (x * x + y * y), 0.0, 1.0);
  return std::hypot(px - along * x, py - along * y);
}

/// A triangle with its corners in counter-clockwise order.
std::vector<GridPoint> random_triangle(Rng& rng, std::int32_t half) {
  for (;;) {
    const GridPoint a = random_grid_point(rng, half), b = random_grid_point(rng, half),
                    c = random_grid_point(rng, half);
    if (orientation(a, b, c) > 0) return {a, b, c};
  }
}

TEST_CASE("split segments share only their ends") {
  const std::uint64_t seed = GENERATE(range(1, 11));
  const std::int32_t half = GENERATE(4, 30, 1000, kMaxGridCoordinate);
  CAPTURE(seed, half);
  Rng rng(seed);
  const std::vector<GridSegment> segments = random_divided_segments(rng, 40, half, half);
  REQUIRE(segments.size() >= 40);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    REQUIRE(segments[i].left < segments[i].right);
    for (std::size_t k = 0; k < i; ++k) REQUIRE_FALSE(overlap_or_cross(segments[i], segments[k]));
  }
}

TEST_CASE("splitting polygons does not change how many of them cover a point far from their boundaries") {
  const std::uint64_t seed = GENERATE(range(1, 11));
  CAPTURE(seed);
  Rng rng(seed);
  constexpr std::int32_t kHalf = 2000;
  std::vector<std::vector<GridPoint>> triangles;
  std::vector<WindingSegment> boundaries;
  for (int i = 0; i < 12; ++i) {
    triangles.push_back(random_triangle(rng, kHalf));
    CrossingDivider::append_boundary(triangles.back(), boundaries);
  }
  REQUIRE(CrossingDivider().divide(boundaries));
  REQUIRE(boundaries.size() > 100);
  int compared = 0, deepest = 0;
  for (int i = 0; i < 2000; ++i) {
    const GridPoint p = random_grid_point(rng, kHalf);
    int covers = 0;
    double nearest = 1e9;
    for (const auto& t : triangles) {
      covers +=
          orientation(t[0], t[1], p) > 0 && orientation(t[1], t[2], p) > 0 && orientation(t[2], t[0], p) > 0;
      for (std::size_t k = 0; k < 3; ++k) nearest = std::min(nearest, distance(p, t[k], t[(k + 1) % 3]));
    }
    if (nearest < 4) continue;
    int winding = 0;
    for (const WindingSegment& part : boundaries)
      if (part.segment.left <= p && p < part.segment.right && height_above(part.segment, p) > 0)
        winding += part.winding;
    CAPTURE(p.x, p.y);
    REQUIRE(winding == covers);
    ++compared;
    deepest = std::max(deepest, covers);
  }
  CHECK(compared > 1000);
  CHECK(deepest >= 3);
}

TEST_CASE("common boundaries of two polygons are merged") {
  std::vector<WindingSegment> boundaries;
  const std::vector<GridPoint> left{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, right{{4, 1}, {8, 1}, {8, 3}, {4, 3}};
  CrossingDivider::append_boundary(left, boundaries);
  CrossingDivider::append_boundary(right, boundaries);
  REQUIRE(CrossingDivider().divide(boundaries));
  // The common part of the edges at x = 4 separates nothing.
  const GridSegment common{{4, 1}, {4, 3}}, below{{4, 0}, {4, 1}};
  const auto find = [&](const GridSegment& segment) {
    return std::find_if(boundaries.begin(), boundaries.end(),
                        [&](const WindingSegment& part) { return part.segment == segment; });
  };
  CHECK(find(common) == boundaries.end());
  REQUIRE(find(below) != boundaries.end());
  // For a vertical segment, the side above is its left side.
  CHECK(find(below)->winding == 1);
}

}  // namespace sidestep::winding_segments_test
