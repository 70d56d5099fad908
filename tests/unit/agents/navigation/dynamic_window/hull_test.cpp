// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/dynamic_window/hull.hpp"

#include "tests/catch.hpp"
#include "tests/unit/agents/navigation/dynamic_window/random_hull.hpp"

namespace sidestep::hull_test {

constexpr double kHorizon_s = 3, kStep_s = 1e-3;

/// Integrates the robot's motion in small steps by the midpoint rule. Calls `visit(time_s, point)` with the
/// point's position in the robot's frame at each step, until it returns false.
template <typename Visit>
void step(const Vec2& point_m, const ArcMotion& motion, Visit visit) {
  Vec2 position(0, 0);
  double heading_rad = 0;
  for (double t = 0; t < kHorizon_s; t += kStep_s) {
    if (!visit(t, rotated(point_m - position, -heading_rad))) return;
    const double middle_rad = heading_rad + motion.turn_rate_radps * kStep_s / 2;
    position += motion.speed_mps * kStep_s * Vec2(std::cos(middle_rad), std::sin(middle_rad));
    heading_rad += motion.turn_rate_radps * kStep_s;
  }
}

TEST_CASE("a point's position in the moving robot's frame agrees with integrating the motion") {
  const std::uint64_t seed = GENERATE(range(1, 200));
  CAPTURE(seed);
  Rng rng(seed);
  const ArcMotion motion = random_motion(rng);
  const Vec2 point = random_point(rng, 2);
  step(point, motion, [&](double t, const Vec2& seen) {
    REQUIRE((point_after_motion(point, motion, t) - seen).norm() < 1e-5);
    return true;
  });
}

TEST_CASE("exact times to collision agree with dense time steps") {
  constexpr double kIntegration_m = 1e-5;
  int hits = 0, misses = 0;
  for (std::uint64_t seed = 1; seed <= 1500; ++seed) {
    CAPTURE(seed);
    Rng scene(seed);
    const ConvexPolygon hull = random_hull(scene, 0.4);
    const Hull outline(hull);
    const ArcMotion motion = random_motion(scene);
    const Vec2 point = random_point(scene, 1.2);
    const double time_s = outline.time_to_collision_s(point, motion);
    CAPTURE(motion.speed_mps, motion.turn_rate_radps, point.x(), point.y(), time_s);
    if (signed_distance(point, hull.corners_m) < 0) {
      REQUIRE(time_s == 0);
      continue;
    }
    // The point is never inside the hull before the time to collision.
    step(point, motion, [&](double t, const Vec2& seen) {
      if (t < time_s) REQUIRE(signed_distance(seen, hull.corners_m) > -kIntegration_m);
      return t < time_s;
    });
    if (time_s > kHorizon_s) {
      ++misses;
      continue;
    }
    // At the time to collision, the point is on the outline.
    ++hits;
    const Vec2 entry = point_after_motion(point, motion, time_s);
    REQUIRE(std::abs(signed_distance(entry, hull.corners_m)) < 1e-8);
  }
  CHECK(hits > 100);
  CHECK(misses > 200);
}

TEST_CASE("times to collision change little between straight and nearly straight motions") {
  const std::uint64_t seed = 11;
  CAPTURE(seed);
  Rng rng(seed);
  int compared = 0;
  for (int i = 0; i < 2000; ++i) {
    const Hull outline(random_hull(rng, 0.4));
    const Vec2 point = random_point(rng, 1.5);
    const double straight_s = outline.time_to_collision_s(point, {0.5, 0});
    const double left_s = outline.time_to_collision_s(point, {0.5, 1e-9});
    const double right_s = outline.time_to_collision_s(point, {0.5, -1e-9});
    // Points that pass the hull within a nanometre may collide or not.
    if (straight_s > 5 || left_s > 5 || right_s > 5) continue;
    ++compared;
    CHECK(left_s == Approx(straight_s).margin(1e-6));
    CHECK(right_s == Approx(straight_s).margin(1e-6));
  }
  CHECK(compared > 100);
}

TEST_CASE("a collision after more than half a turn of the robot is found") {
  // The robot turns left on the spot; the point lies on its right.
  const Hull outline(ConvexPolygon{{{0, -0.01}, {1, -0.01}, {1, 0.01}, {0, 0.01}}});
  const double time_s = outline.time_to_collision_s({0, -0.5}, {0, 1});
  CHECK(time_s == Approx(1.5 * std::numbers::pi - std::asin(0.01 / 0.5)).margin(1e-9));
  CHECK(std::isinf(outline.time_to_collision_s({0, -1.2}, {0, 1})));
}

TEST_CASE("a padded hull contains all points within its padding and no points much farther away") {
  const std::uint64_t seed = GENERATE(range(1, 60));
  CAPTURE(seed);
  Rng rng(seed);
  const ConvexPolygon hull = random_hull(rng, 0.4);
  const double padding_m = rng.uniform(0.001, 0.1);
  const ConvexPolygon outer = padded(hull, padding_m);
  const Hull outline(outer);
  int near = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec2 point = random_point(rng, 0.8);
    const double distance_m = signed_distance(point, hull.corners_m);
    if (distance_m < padding_m) {
      ++near;
      REQUIRE(outline.contains(point));
    }
    // The cut corners extend at most this far.
    if (distance_m > 1.42 * padding_m) REQUIRE_FALSE(outline.contains(point));
  }
  CHECK(near > 0);
}

TEST_CASE("invalid hulls and paddings are refused") {
  const ConvexPolygon clockwise{{{0, 0}, {0, 1}, {1, 0}}}, line{{{0, 0}, {1, 0}}};
  CHECK_THROWS_AS(Hull(clockwise), std::invalid_argument);
  CHECK_THROWS_AS(Hull(line), std::invalid_argument);
  const ConvexPolygon triangle{{{0, 0}, {1, 0}, {0, 1}}};
  CHECK_THROWS_AS(padded(triangle, -0.1), std::invalid_argument);
  CHECK_THROWS_AS(padded(triangle, std::nan("")), std::invalid_argument);
}

}  // namespace sidestep::hull_test
