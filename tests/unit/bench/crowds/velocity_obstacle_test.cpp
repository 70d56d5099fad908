// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/velocity_obstacle.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include "common/geometry/convex_polygon.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::velocity_obstacle_test {

constexpr double kHorizon_s = 0.8;

/// The smallest distance between the robot's centre and the obstacle within the horizon.
double nearest_approach_m(const std::vector<Vec2>& corners, const Vec2& velocity) {
  const Segment path{{0, 0}, kHorizon_s * velocity};
  if (corners.size() > 2) return std::sqrt(squared_distance(path, corners));
  return std::sqrt(squared_distance(path, Segment{corners.front(), corners.back()}));
}

std::vector<Vec2> random_obstacle(std::size_t count, Rng& rng) {
  const double turn_rad = rng.uniform(0, 2 * std::numbers::pi), distance_m = rng.uniform(0.3, 1.5),
               size_m = rng.uniform(0.05, 0.8);
  const double first_rad = rng.uniform(0, 2 * std::numbers::pi);
  std::vector<Vec2> corners;
  for (std::size_t i = 0; i < count; ++i) {
    const double corner_rad =
        first_rad + 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
    corners.push_back(rotated({distance_m, 0}, turn_rad) + rotated({size_m, 0}, corner_rad));
  }
  return corners;
}

TEST_CASE("velocities in the half-plane are free, and no boundary of the velocity obstacle is nearer") {
  const auto count = GENERATE(1u, 2u, 4u, 5u);
  int examined = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    CAPTURE(count, seed);
    Rng rng(seed);
    const std::vector<Vec2> corners = random_obstacle(count, rng);
    const double separation_m = rng.uniform(0.05, 0.4), x = rng.uniform(-3, 3), y = rng.uniform(-3, 3);
    const Vec2 velocity(x, y);
    const RelativeObstacle obstacle{corners, separation_m};
    if (nearest_point_m(obstacle).norm() < separation_m + 0.01) continue;
    ++examined;
    const HalfPlane plane = outside_velocity_obstacle(obstacle, kHorizon_s, velocity);
    CHECK(plane.normal.norm() == Approx(1));
    CHECK(nearest_approach_m(corners, plane.point) == Approx(separation_m).margin(1e-6));
    const double to_boundary = (plane.point - velocity).norm();
    const bool is_free = nearest_approach_m(corners, velocity) >= separation_m;
    CHECK(plane.depth(velocity) == Approx(is_free ? to_boundary : -to_boundary).margin(1e-6));
    for (int i = 0; i < 50; ++i) {
      const double across = rng.uniform(-3, 3), depth = rng.uniform(1e-6, 3);
      const Vec2 permitted = plane.point + across * left_of(plane.normal) + depth * plane.normal;
      REQUIRE(nearest_approach_m(corners, permitted) > separation_m - 1e-6);
      const double turn_rad = rng.uniform(0, 2 * std::numbers::pi);
      const Vec2 nearer = velocity + rotated({0.999 * to_boundary, 0}, turn_rad);
      REQUIRE((nearest_approach_m(corners, nearer) >= separation_m - 1e-9) == is_free);
    }
  }
  CHECK(examined > 200);
}

TEST_CASE("discs that overlap are apart in time if their relative velocity is in the half-plane") {
  const Vec2 offset(0.1, 0.05), velocity(0.4, -0.3);
  const double separation_m = 0.2, within_s = 0.1;
  const HalfPlane plane = separating_velocities(offset, separation_m, within_s, velocity);
  CHECK((within_s * plane.point - offset).norm() == Approx(separation_m));
  CHECK(cross(plane.point - velocity, plane.normal) == Approx(0).margin(1e-9));
  CHECK(plane.depth(velocity) < 0);
}

}  // namespace sidestep::velocity_obstacle_test
