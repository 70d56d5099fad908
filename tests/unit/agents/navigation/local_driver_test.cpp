// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/local_driver.hpp"

#include <cmath>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::local_driver_test {

constexpr Field kField{8, 6};
constexpr MotionLimits kLimits{};
constexpr double kRadius_m = 0.09, kSeparation_m = 0.1, kTolerance_m = 0.002;
constexpr double kCycle_s = 1.0 / 30;

LocalDriver driver(const LocalMethods& methods) {
  return {methods, kField, kRadius_m, kSeparation_m, kLimits};
}

double distance_m(const Vec2& at, const Segment& segment) { return std::sqrt(squared_distance(at, segment)); }

TEST_CASE("on an open floor, the window heads for the end of the path") {
  LocalDriver local = driver({.uses_window = true});
  const ObstacleWorld world;
  const std::vector<Vec2> path{{2, 1}};
  const LocalChoice choice = local.choose({{{-2, -1}, {0, 0}}, path, &world, {}, kCycle_s});
  CHECK(choice.target_m == path.front());
  REQUIRE(choice.velocity_mps);
  CHECK(choice.velocity_mps->normalized().dot(Vec2(2, 1).normalized()) > 0.95);
}

TEST_CASE("a window that ignores the path heads for the path's end instead of a waypoint") {
  LocalDriver local = driver({.uses_window = true, .ignores_path = true});
  const ObstacleWorld world;
  const std::vector<Vec2> path{{0, 2}, {2, 0}};
  const LocalChoice choice = local.choose({{{-2, 0}, {0, 0}}, path, &world, {}, kCycle_s});
  CHECK(choice.target_m == Vec2(2, 0));
}

TEST_CASE("a local driver chooses no velocity near the goal, too near to an obstacle or without a window") {
  const ObstacleWorld world({Circle{{0, 0.3}, 0.25}});
  const std::vector<Vec2> near{{0.1, -0.5}}, far{{2, 0}};
  LocalDriver local = driver({.uses_window = true});
  CHECK_FALSE(local.choose({{{0, -0.5}, {0, 0}}, near, &world, {}, kCycle_s}).velocity_mps);
  CHECK_FALSE(local.choose({{{0, 0}, {0, 0}}, far, &world, {}, kCycle_s}).velocity_mps);
  LocalDriver band = driver({.uses_band = true});
  CHECK_FALSE(band.choose({{{-2, -1}, {0, 0}}, far, &world, {}, kCycle_s}).velocity_mps);
}

TEST_CASE("every velocity of the window lets the robot stop before it reaches any disc or body") {
  // The window sees only the first obstacle on each ray, but discs as wide as the robot cannot hide between
  // rays.
  int chosen = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    std::vector<Shape> shapes;
    std::vector<Circle> others;
    for (int i = 0; i < 6; ++i) {
      const auto disc = [&] {
        const double angle_rad = rng.uniform(-3.1, 3.1), distance_m = rng.uniform(0.5, 1.2);
        return Circle{distance_m * Vec2(std::cos(angle_rad), std::sin(angle_rad)), rng.uniform(0.09, 0.3)};
      };
      shapes.emplace_back(disc());
      others.push_back(disc());
    }
    const ObstacleWorld world(shapes);
    LocalDriver local = driver({.uses_window = true});
    const std::vector<Vec2> path{{2.5, 0}};
    const LocalChoice choice = local.choose({{{0, 0}, {0, 0}}, path, &world, others, kCycle_s});
    if (!choice.velocity_mps) continue;
    ++chosen;
    std::vector<Vec2> velocities(choice.preferred_mps.begin(), choice.preferred_mps.end());
    velocities.push_back(*choice.velocity_mps);
    for (const Vec2& velocity : velocities) {
      const Vec2 stop = velocity * (kCycle_s + velocity.norm() / kLimits.deceleration_mps2 / 2);
      // The outlines of discs lie up to 4 mm in front of the points on the rays.
      CHECK_FALSE(world.touches({0, 0}, stop, kSeparation_m - 0.01));
      for (const Circle& other : others)
        CHECK(distance_m(other.centre_m, Segment{{0, 0}, stop}) > other.radius_m + kSeparation_m - 0.01);
    }
  }
  CHECK(chosen >= 10);
}

TEST_CASE("a potential field pushes a robot to the right of an oncoming robot, and away from walls") {
  LocalDriver local = driver({.uses_field = true});
  const std::vector<Vec2> path{{3, 0}};
  const ObstacleWorld open;
  const LocalChoice alone = local.choose({{{-2, 0}, {0, 0}}, path, &open, {}, kCycle_s});
  REQUIRE(alone.velocity_mps);
  CHECK((*alone.velocity_mps - Vec2(kLimits.speed_mps, 0)).norm() < 1e-9);
  const std::vector<Circle> ahead{{{-1.65, 0}, kRadius_m}};
  const LocalChoice meeting = local.choose({{{-2, 0}, {0, 0}}, path, &open, ahead, kCycle_s});
  REQUIRE(meeting.velocity_mps);
  CHECK(meeting.velocity_mps->y() < -0.01);
  const ObstacleWorld wall({Box{{-4, 0.2}, {4, 0.3}}});
  const LocalChoice along = local.choose({{{-2, 0.05}, {0, 0}}, path, &wall, {}, kCycle_s});
  REQUIRE(along.velocity_mps);
  CHECK(along.velocity_mps->y() < -0.01);
}

TEST_CASE("a potential field chooses no velocity in a local minimum") {
  LocalDriver local = driver({.uses_field = true});
  const std::vector<Vec2> path{{3, 0}};
  const ObstacleWorld wall({Box{{-1.85, -1}, {-1.8, 1}}});
  CHECK_FALSE(local.choose({{{-1.97, 0}, {0, 0}}, path, &wall, {}, kCycle_s}).velocity_mps);
}

TEST_CASE("a band leads around a body on the path, and the straight line to the band's target is free") {
  const std::uint64_t seed = GENERATE(range<std::uint64_t>(1, 21));
  CAPTURE(seed);
  Rng rng(seed);
  LocalDriver local = driver({.uses_band = true});
  const ObstacleWorld world;
  const std::vector<Vec2> path{{2, 0}};
  // The body approaches the path from the side, more slowly than the band moves.
  const double side = rng.uniform(0, 1) < 0.5 ? -1 : 1, x = rng.uniform(-1, 1);
  Circle body{{x, 0.5 * side}, 0.15};
  LocalChoice choice;
  for (int i = 0; i < 200; ++i) {
    body.centre_m.y() -= side * 0.002;
    choice = local.choose({{{-2, 0}, {0, 0}}, path, &world, {&body, 1}, kCycle_s});
  }
  REQUIRE_FALSE(local.bubbles().empty());
  Vec2 last = local.bubbles().front().centre_m;
  for (const Bubble& bubble : local.bubbles()) {
    CHECK(distance_m(body.centre_m, Segment{last, bubble.centre_m}) >=
          body.radius_m + kSeparation_m - kTolerance_m - 1e-6);
    last = bubble.centre_m;
  }
  CHECK(distance_m(body.centre_m, Segment{{-2, 0}, choice.target_m}) >=
        body.radius_m + kSeparation_m - kTolerance_m - 1e-6);
}

TEST_CASE("a path to another goal replaces the band, and a robot without a band follows the path itself") {
  LocalDriver local = driver({.uses_band = true});
  const ObstacleWorld open;
  const std::vector<Vec2> first{{2, 0}}, second{{0, 1}, {-2, 2}};
  const State at{{-2, 0}, {0, 0}};
  CHECK(local.choose({at, first, &open, {}, kCycle_s}).target_m.x() < 2);
  REQUIRE_FALSE(local.bubbles().empty());
  CHECK(local.bubbles().back().centre_m == Vec2(2, 0));
  CHECK(local.choose({at, second, &open, {}, kCycle_s}).target_m.y() > 0);
  REQUIRE_FALSE(local.bubbles().empty());
  CHECK(local.bubbles().back().centre_m == Vec2(-2, 2));
  const ObstacleWorld gap({Box{{-0.1, 0.08}, {0.1, 3}}, Box{{-0.1, -3}, {0.1, -0.08}}});
  CHECK(local.choose({at, first, &gap, {}, kCycle_s}).target_m == Vec2(2, 0));
  CHECK(local.bubbles().empty());
}

}  // namespace sidestep::local_driver_test
