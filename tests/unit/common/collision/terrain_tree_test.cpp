// SPDX-License-Identifier: Apache-2.0
#include "common/collision/terrain_tree.hpp"

#include <limits>

#include "tests/catch.hpp"
#include "tests/unit/common/collision/random_terrain.hpp"

namespace sidestep::terrain_tree_test {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double height_at(const HeightField& field, std::size_t column, std::size_t row) {
  return field.heights_m[row * field.columns + column];
}

/// The terrain's height, interpolated between the corners of a triangle.
double terrain_height(const HeightField& field, const Vec2& position) {
  const Vec2 grid = (position - field.corner_m) / field.spacing_m;
  const double last_column = static_cast<double>(field.columns - 1),
               last_row = static_cast<double>(field.rows - 1);
  if (grid.x() < 0 || grid.y() < 0 || grid.x() > last_column || grid.y() > last_row) return -kInfinite;
  const auto column = static_cast<std::size_t>(std::min(grid.x(), last_column - 1));
  const auto row = static_cast<std::size_t>(std::min(grid.y(), last_row - 1));
  const double u = grid.x() - static_cast<double>(column), v = grid.y() - static_cast<double>(row);
  const double right = height_at(field, column + 1, row), above = height_at(field, column, row + 1);
  if (u + v <= 1) {
    const double corner = height_at(field, column, row);
    return corner + u * (right - corner) + v * (above - corner);
  }
  const double corner = height_at(field, column + 1, row + 1);
  return corner + (1 - u) * (above - corner) + (1 - v) * (right - corner);
}

/// Points of the terrain, at `per_square` intervals per grid square.
std::vector<Vec3> sampled_terrain(const HeightField& field, std::size_t per_square) {
  std::vector<Vec3> points;
  const double step = field.spacing_m / static_cast<double>(per_square);
  for (std::size_t i = 0; i <= (field.columns - 1) * per_square; ++i) {
    for (std::size_t k = 0; k <= (field.rows - 1) * per_square; ++k) {
      const Vec2 position = field.corner_m + step * Vec2(static_cast<double>(i), static_cast<double>(k));
      points.emplace_back(position.x(), position.y(), terrain_height(field, position));
    }
  }
  return points;
}

TEST_CASE("the distance to terrain is the distance to its nearest point") {
  const std::uint64_t seed = GENERATE(range(1, 5));
  CAPTURE(seed);
  Rng rng(seed);
  const HeightField field = random_terrain(rng, 12, 9);
  const TerrainTree tree(field);
  const std::vector<Vec3> points = sampled_terrain(field, 20);
  for (int i = 0; i < 60; ++i) {
    const Vec3 from = random_position_above(rng, field), to = random_position_above(rng, field);
    double point_m = kInfinite, line_m = kInfinite;
    for (const Vec3& point : points) {
      const Vec3 displacement = to - from;
      const double part = std::clamp((point - from).dot(displacement) / displacement.squaredNorm(), 0.0, 1.0);
      point_m = std::min(point_m, (point - from).norm());
      line_m = std::min(line_m, (point - from - part * displacement).norm());
    }
    CAPTURE(from.transpose(), to.transpose());
    CHECK(tree.distance_m(from) <= point_m + 1e-12);
    CHECK(tree.distance_m(from) >= point_m - 0.08);
    CHECK(tree.distance_m(from, to) <= line_m + 1e-12);
    CHECK(tree.distance_m(from, to) >= line_m - 0.08);
  }
}

Vec3 random_vector(Rng& rng, double min, double max) {
  const double z = rng.uniform(min, max), y = rng.uniform(min, max), x = rng.uniform(min, max);
  return {x, y, z};
}

TEST_CASE("the terrain tree agrees with a search over all triangles") {
  const std::uint64_t seed = GENERATE(range(1, 5));
  CAPTURE(seed);
  Rng rng(seed);
  std::vector<Vec3> points;
  std::vector<TerrainTree::Corners> corners;
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < 200; ++i) {
    const Vec3 middle = random_vector(rng, -5, 5);
    for (int k = 0; k < 3; ++k) points.push_back(middle + random_vector(rng, 0, 1));
    corners.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    triangles.push_back({points.end()[-3], points.end()[-2], points.end()[-1]});
  }
  const TerrainTree tree(points, corners);
  for (int i = 0; i < 200; ++i) {
    const Vec3 from = random_vector(rng, -6, 6);
    const Vec3 to = rng.chance(0.1) ? from : Vec3(from + random_vector(rng, -3, 3));
    double nearest2 = kInfinite;
    for (const Triangle& triangle : triangles)
      nearest2 = std::min(nearest2, squared_distance(from, to, triangle));
    CHECK(tree.distance_m(from, to) == Approx(std::sqrt(nearest2)).margin(1e-12));
  }
}

TEST_CASE("the minimum height above terrain agrees with sampling along the path") {
  const std::uint64_t seed = GENERATE(range(1, 10));
  CAPTURE(seed);
  Rng rng(seed);
  const HeightField field = random_terrain(rng, 20, 15);
  const TerrainTree tree(field);
  for (int i = 0; i < 60; ++i) {
    const Vec3 from = 1.2 * random_position_above(rng, field), to = 1.2 * random_position_above(rng, field);
    double sampled = kInfinite;
    constexpr int kSteps = 4000;
    for (int k = 0; k <= kSteps; ++k) {
      const Vec3 p = from + static_cast<double>(k) / kSteps * (to - from);
      sampled = std::min(sampled, p.z() - terrain_height(field, p.head<2>()));
    }
    CAPTURE(from.transpose(), to.transpose());
    if (sampled == kInfinite) continue;
    CHECK(tree.min_height_m(from, to) <= sampled + 1e-6);
    CHECK(tree.min_height_m(from, to) >= sampled - 0.1);
    const double here = from.z() - terrain_height(field, from.head<2>());
    if (here < kInfinite) CHECK(tree.min_height_m(from, from) == Approx(here).margin(1e-6));
  }
}

TEST_CASE("a ball touches terrain if it comes within its radius or starts below it") {
  const std::uint64_t seed = GENERATE(range(1, 10));
  CAPTURE(seed);
  Rng rng(seed);
  const HeightField field = random_terrain(rng, 20, 15);
  const TerrainTree tree(field);
  for (int i = 0; i < 60; ++i) {
    const Vec3 from = random_position_above(rng, field);
    const double dz = rng.uniform(-1, 1), dy = rng.uniform(-4, 4), dx = rng.uniform(-4, 4);
    const Vec3 to = from + Vec3(dx, dy, dz);
    const double distance = tree.distance_m(from, to), radius = rng.uniform(0, 1);
    const bool is_below = tree.min_height_m(from, from) <= 0;
    CHECK(tree.touches(from, to, distance + 1e-9));
    if (!is_below && distance > 1e-9) CHECK_FALSE(tree.touches(from, to, distance - 1e-9));
    CHECK(tree.touches(from, to, radius) == (is_below || distance <= radius));
  }
}

TEST_CASE("positions on edges between triangles have terrain below them") {
  const TerrainTree tree(HeightField{{0, 0}, 0.1, 4, 4, std::vector<double>(16, 2.0)});
  for (int i = 0; i <= 30; ++i) {
    for (int k = 0; k <= 30; ++k) {
      const Vec3 p(0.01 * i, 0.01 * k, 5);
      CAPTURE(i, k);
      CHECK(tree.min_height_m(p, p) == Approx(3));
    }
  }
  CHECK(tree.min_height_m({-0.01, 0, 5}, {-0.01, 3, 5}) == kInfinite);
}

TEST_CASE("invalid terrain and invalid queries are rejected") {
  CHECK_THROWS_WITH(TerrainTree(HeightField{{0, 0}, 1, 1, 5, std::vector<double>(5)}),
                    "a height field needs at least two columns and two rows");
  CHECK_THROWS_WITH(TerrainTree(HeightField{{0, 0}, 1, 2, 2, std::vector<double>(5)}),
                    "a height field needs columns * rows heights");
  CHECK_THROWS_AS(TerrainTree(HeightField{{0, 0}, 0, 2, 2, std::vector<double>(4)}), std::invalid_argument);
  CHECK_THROWS_AS(TerrainTree(HeightField{{0, 0}, 1, 2, 2, {0, 0, kNan, 0}}), std::invalid_argument);
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  CHECK_THROWS_WITH(TerrainTree(points, {}), "a terrain has no triangles");
  CHECK_THROWS_WITH(TerrainTree(points, {{0, 1, 3}}),
                    "a terrain triangle refers to a corner that does not exist");
  const TerrainTree tree(points, {{0, 1, 2}});
  CHECK_THROWS_AS(tree.distance_m({0, kNan, 0}), std::invalid_argument);
  CHECK_THROWS_AS(tree.touches({0, 0, 1}, {0, kInfinite, 0}, 1), std::invalid_argument);
  CHECK_THROWS_AS(tree.touches({0, 0, 1}, {0, 0, 1}, -1), std::invalid_argument);
  CHECK_THROWS_AS(tree.min_height_m({0, 0, kNan}, {0, 0, 1}), std::invalid_argument);
}

}  // namespace sidestep::terrain_tree_test
