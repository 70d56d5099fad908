// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/planning/rounded_shape.hpp"

#include "common/random/rng.hpp"
#include "deploy/trial/planning/worlds.hpp"
#include "tests/catch.hpp"

namespace sidestep::rounded_shape_test {

constexpr double kStep_m = 0.05;

/// Points that cover a shape without its radius, at most kStep_m apart in each direction.
std::vector<Vec2> points_of(const RoundedShape& shape) {
  const std::vector<Vec2>& corners = shape.corners_m;
  std::vector<Vec2> points;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (double part = 0; part <= 1; part += kStep_m / 2)
      for (double inwards = 0; inwards <= 1; inwards += corners.size() < 3 ? 2 : kStep_m * 2)
        points.push_back((1 - inwards) *
                             (corners[i] + part * (corners[(i + 1) % corners.size()] - corners[i])) +
                         inwards * corners[0]);
  }
  return points;
}

double sampled_distance_m(const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
  double nearest2_m2 = 1e9;
  for (const Vec2& p : a)
    for (const Vec2& q : b) nearest2_m2 = std::min(nearest2_m2, (p - q).squaredNorm());
  return std::sqrt(nearest2_m2);
}

TEST_CASE("the closest points of two shapes are as close as dense samples and lie on both shapes") {
  const auto seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Rng rng(seed);
  const PlanWorld world = make_world("mixed", 1, seed);
  for (int i = 0; i < 15; ++i) {
    const RoundedShape a = rounded(world.obstacles[rng.below(world.obstacles.size())]);
    RoundedShape b = rounded(world.obstacles[rng.below(world.obstacles.size())]);
    const double y = rng.uniform(-1, 1), x = rng.uniform(-1, 1);
    const Vec2 shift = a.corners_m[0] - b.corners_m[0] + Vec2(x, y);
    for (Vec2& corner : b.corners_m) corner += shift;
    const ClosestPoints closest = closest_points(a.corners_m, b.corners_m);
    const double sampled_m = sampled_distance_m(points_of(a), points_of(b));
    CHECK(closest.distance_m <= sampled_m + 1e-9);
    CHECK(closest.distance_m >= sampled_m - 3 * kStep_m);
    CHECK((closest.a_m - closest.b_m).norm() == Approx(closest.distance_m).margin(1e-9));
    CHECK(closest_points(a.corners_m, std::vector{closest.a_m}).distance_m < 1e-9);
    CHECK(closest_points(b.corners_m, std::vector{closest.b_m}).distance_m < 1e-9);
  }
}

TEST_CASE("a point outside a shape has the same distance from its rounded form") {
  Rng rng(5);
  const PlanWorld world = make_world("mixed", 1, 5);
  for (const Shape& shape : world.obstacles) {
    for (int i = 0; i < 20; ++i) {
      const double y = rng.uniform(-5, 5), x = rng.uniform(-5, 5);
      const Vec2 p(x, y);
      const RoundedShape round = rounded(shape);
      const double distance_m = closest_points(round.corners_m, std::vector{p}).distance_m - round.radius_m;
      const double expected_m = signed_distance(p, shape);
      CHECK((expected_m > 0 ? distance_m == Approx(expected_m).margin(1e-12) : distance_m <= 1e-12));
    }
  }
}

}  // namespace sidestep::rounded_shape_test
