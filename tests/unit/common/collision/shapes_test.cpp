// SPDX-License-Identifier: Apache-2.0
#include "common/collision/shapes.hpp"

#include <limits>
#include <numbers>

#include "tests/catch.hpp"
#include "tests/unit/common/collision/random_world.hpp"

namespace sidestep::shapes_test {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Points along a shape's boundary, 1/1000 of an edge or 1 mrad apart.
std::vector<Vec2> boundary_of(const Shape& shape) {
  std::vector<Vec2> corners, boundary;
  if (const auto* circle = std::get_if<Circle>(&shape)) {
    for (double angle = 0; angle < 6.2832; angle += 1e-3)
      boundary.push_back(circle->centre_m + rotated(Vec2(circle->radius_m, 0), angle));
    return boundary;
  }
  if (const auto* box = std::get_if<Box>(&shape))
    corners = {box->min_m, {box->max_m.x(), box->min_m.y()}, box->max_m, {box->min_m.x(), box->max_m.y()}};
  if (const auto* segment = std::get_if<Segment>(&shape)) corners = {segment->from_m, segment->to_m};
  if (const auto* polygon = std::get_if<ConvexPolygon>(&shape)) corners = polygon->corners_m;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 edge = corners[(i + 1) % corners.size()] - corners[i];
    for (double fraction = 0; fraction < 1; fraction += 1e-3)
      boundary.push_back(corners[i] + fraction * edge);
  }
  return boundary;
}

/// Whether a ray from the point in the x direction crosses the boundary an odd number of times.
bool is_inside(const Vec2& p, const Shape& shape) {
  if (std::holds_alternative<Segment>(shape)) return false;
  const std::vector<Vec2> boundary = boundary_of(shape);
  bool inside = false;
  for (std::size_t i = 0; i < boundary.size(); ++i) {
    const Vec2 &a = boundary[i], &b = boundary[(i + 1) % boundary.size()];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
  }
  return inside;
}

TEST_CASE("the distance to a shape is the distance to the nearest point of its boundary") {
  const std::uint64_t seed = GENERATE(range(1, 60));
  CAPTURE(seed);
  Rng rng(seed);
  const Shape shape = random_shape(rng, 1, 0.6);
  for (int i = 0; i < 20; ++i) {
    const Vec2 p = random_position(rng, 1.5);
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec2& q : boundary_of(shape)) nearest = std::min(nearest, (p - q).norm());
    CAPTURE(shape.index(), p.x(), p.y());
    CHECK(std::abs(signed_distance(p, shape)) == Approx(nearest).margin(2e-3));
    if (nearest > 2e-3) CHECK((signed_distance(p, shape) < 0) == is_inside(p, shape));
  }
}

TEST_CASE("the nearest boundary point and the facing disc are at the same distance as the shape") {
  Rng rng(2);
  int inside = 0;
  for (int i = 0; i < 2000; ++i) {
    const Shape shape = random_shape(rng, 2, 1);
    const double y = rng.uniform(-2, 2), x = rng.uniform(-2, 2);
    const Vec2 p(x, y), nearest = nearest_boundary_point(p, shape);
    const double distance = signed_distance(p, shape);
    inside += distance < 0;
    CAPTURE(i, distance);
    REQUIRE((nearest - p).norm() == Approx(std::abs(distance)).margin(1e-12));
    REQUIRE(std::abs(signed_distance(nearest, shape)) < 1e-12);
    const Circle facing = disc_facing(p, shape);
    REQUIRE((facing.centre_m - p).norm() - facing.radius_m == Approx(distance).margin(1e-12));
  }
  CHECK(inside > 50);
}

TEST_CASE("the distance between a segment and a shape is the minimum over the segment's points") {
  const std::uint64_t seed = GENERATE(range(1, 200));
  CAPTURE(seed);
  Rng rng(seed);
  const Shape shape = random_shape(rng, 1, 0.6);
  for (int i = 0; i < 20; ++i) {
    const Vec2 from = random_position(rng, 1.5), to = from + random_displacement(rng, 1);
    const double sampled = std::max(0.0, sampled_distance(from, to, shape, 500));
    const double exact = std::sqrt(squared_distance(Segment{from, to}, shape));
    CAPTURE(shape.index(), from.x(), from.y(), to.x(), to.y());
    CHECK(exact <= sampled + 1e-12);
    CHECK(exact >= sampled - 1e-3);
  }
}

TEST_CASE("disjoint collinear segments do not touch") {
  Rng rng(7);
  for (int i = 0; i < 1000; ++i) {
    const Vec2 start = random_position(rng, 1), edge = rotated(Vec2(1, 0), rng.uniform(0, 6.28));
    const Segment one{start, start + 0.3 * edge}, other{start + 0.5 * edge, start + 0.9 * edge};
    CHECK(squared_distance(one, other) == Approx(0.04));
  }
}

TEST_CASE("bounds contain a shape and move with it") {
  const std::uint64_t seed = GENERATE(range(1, 40));
  CAPTURE(seed);
  Rng rng(seed);
  const Shape shape = random_shape(rng, 1, 0.6);
  const Vec2 by = random_position(rng, 5);
  const Box box = bounds(shape), after = bounds(moved(shape, by));
  for (const Vec2& p : boundary_of(shape)) CHECK(signed_distance(p, box) < 1e-12);
  CHECK((after.min_m - by - box.min_m).norm() < 1e-12);
  CHECK((after.max_m - by - box.max_m).norm() < 1e-12);
}

TEST_CASE("invalid shapes are rejected") {
  const double infinite = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH(check(Circle{{0, 0}, -0.1}), "a circle's radius is negative");
  CHECK_THROWS_AS(check(Circle{{0, kNan}, 0.1}), std::invalid_argument);
  CHECK_THROWS_AS(check(Circle{{0, 0}, infinite}), std::invalid_argument);
  CHECK_THROWS_WITH(check(Box{{1, 0}, {0, 1}}), "a box's minimum is above its maximum");
  CHECK_THROWS_AS(check(Box{{0, 0}, {kNan, 1}}), std::invalid_argument);
  CHECK_THROWS_AS(check(Segment{{0, 0}, {infinite, 0}}), std::invalid_argument);
  CHECK_THROWS_AS(check(Segment{{0, 0}, {kNan, 0}}), std::invalid_argument);
  CHECK_THROWS_AS(check(Segment{{0, 0}, {1e16, 0}}), std::invalid_argument);
  CHECK_THROWS_AS(check(ConvexPolygon{{{0, 0}, {1, 0}, {kNan, 1}}}), std::invalid_argument);
  CHECK_THROWS_WITH(check(ConvexPolygon{{{0, 0}, {1, 0}}}), "a polygon has fewer than three corners");
  const char* const not_convex = "a polygon is not convex, or its corners are clockwise";
  CHECK_THROWS_WITH(check(ConvexPolygon{{{0, 0}, {0, 1}, {1, 0}}}), not_convex);
  CHECK_THROWS_WITH(check(ConvexPolygon{{{0, 0}, {2, 0}, {0.5, 0.5}, {0, 2}}}), not_convex);
  CHECK_THROWS_AS(check(ConvexPolygon{{{0, 0}, {0, 0}, {1, 0}, {0, 1}}}), std::invalid_argument);
  CHECK_THROWS_AS(check(ConvexPolygon{{{0, 0}, {1, 0}, {2, 0}}}), std::invalid_argument);
  ConvexPolygon star;
  for (int i = 0; i < 5; ++i) star.corners_m.push_back(rotated(Vec2(1, 0), 4 * i * std::numbers::pi / 5));
  CHECK_THROWS_WITH(check(star), "a polygon's boundary must make exactly one full turn");
}

TEST_CASE("shapes without an interior are valid") {
  CHECK_NOTHROW(check(Circle{{1, 2}, 0}));
  CHECK_NOTHROW(check(Box{{1, 2}, {1, 2}}));
  CHECK_NOTHROW(check(Segment{{1, 2}, {1, 2}}));
  CHECK_NOTHROW(check(ConvexPolygon{{{0, 0}, {1, 0}, {2, 0}, {1, 1}}}));
}

}  // namespace sidestep::shapes_test
