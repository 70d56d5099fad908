// SPDX-License-Identifier: Apache-2.0
#include "agents/perception/laser_sight.hpp"

#include <set>

#include "tests/catch.hpp"

namespace sidestep::laser_sight_test {

/// The distance from the front of a person, who leans against a wall facing the robot, to the nearest
/// frontier.
double nearest_frontier_m(double person_radius_m, double range_error_m, double pose_error_m) {
  FloorRules rules;
  rules.obstacles = {Box{{1, -3}, {1.2, 3}}};
  LaserSpec laser;
  laser.settings = {1440, 2 * std::numbers::pi, 0.05, 8};
  laser.person_radius_m = person_radius_m;
  laser.range_error_m = range_error_m;
  const Circle person{{1 - person_radius_m, 0}, person_radius_m};
  const ObstacleWorld world(rules.obstacles);
  std::vector<float> ranges(1440);
  LaserScanner(laser.settings).scan({nullptr, nullptr, &world, {&person, 1}}, {0, 0}, 0, ranges);
  LaserSight sight(laser, rules, {.position_error_m = pose_error_m});
  REQUIRE(sight.update({{0, 0}, 0, time_from_ns(1'000'000'000), ranges}, {}));
  const Vec2 front = person.centre_m - Vec2(person_radius_m, 0);
  double nearest_m = 1e9;
  for (const Frontier& frontier : sight.visibility().frontiers())
    nearest_m = std::min(nearest_m, std::sqrt(squared_distance(front, frontier.segment)));
  return nearest_m;
}

TEST_CASE("a small person leaning against a wall is not mistaken for the wall, even in an inaccurate scan") {
  for (const double radius_m : {0.03, 0.05, 0.15})
    for (const double range_error_m : {0.0, 0.01})
      for (const double pose_error_m : {0.02, 0.07, 0.12}) {
        CAPTURE(radius_m, range_error_m, pose_error_m);
        CHECK(nearest_frontier_m(radius_m, range_error_m, pose_error_m) < range_error_m + 0.1);
      }
}

/// A laser among discs that are not in the floor rules.
struct Watched {
  FloorRules rules;
  LaserSpec laser;
  std::vector<float> ranges = std::vector<float>(720);
  LaserSightSettings settings;

  Watched() { laser.settings = {720, 2 * std::numbers::pi, 0.05, 8}; }
  bool scan(LaserSight& sight, const Vec2& at_m, Time at, std::span<const Circle> discs) {
    const ObstacleWorld world(rules.obstacles);
    LaserScanner(laser.settings).scan({nullptr, nullptr, &world, discs}, at_m, 0, ranges);
    return sight.update({at_m, 0, at, ranges}, {});
  }
};

constexpr Time kBegin = time_from_ns(1'000'000'000);
constexpr Duration kPeriod = std::chrono::milliseconds(100);

TEST_CASE("a scan that is not newer than the last one changes nothing") {
  Watched watched;
  LaserSight sight(watched.laser, watched.rules);
  const Circle near{{1, 0}, 0.2}, far{{3, 0}, 0.2};
  REQUIRE(watched.scan(sight, {0, 0}, kBegin, {&near, 1}));
  for (const Duration earlier : {Duration{0}, kPeriod}) {
    CHECK_FALSE(watched.scan(sight, {0, 0}, kBegin - earlier, {&far, 1}));
    CHECK(sight.captured_at() == kBegin);
    CHECK(std::ranges::min(sight.beams().all(), {}, &Beam::free_m).free_m == Approx(0.8));
  }
}

TEST_CASE("unknown objects that stay stationary for a while are reported as squares, nearest first") {
  Watched watched;
  watched.settings.max_unknown = 3;
  const Vec2 at_m(10, -7);  // far from the origin, from which distances must not be measured
  watched.rules.obstacles = {Circle{at_m + Vec2(0, 1.5), 0.3}};
  LaserSight sight(watched.laser, watched.rules, watched.settings);
  // The second disc is nearer to the origin than the first, and the last one is out of range.
  const std::vector<Circle> standing{
      {at_m + Vec2(1, 0), 0.1}, {at_m + Vec2(-2, 0), 0.1}, {at_m + Vec2(0, -3), 0.1}};
  Time at = kBegin;
  for (; at < kBegin + LaserSight::kUnknownAfter; at += kPeriod) {
    REQUIRE(watched.scan(sight, at_m, at, standing));
    CHECK(sight.unknown().empty());
  }
  for (int i = 0; i < 3; ++i, at += kPeriod) REQUIRE(watched.scan(sight, at_m, at, standing));
  REQUIRE(sight.unknown().size() == 3);
  double last_m = 0;
  std::set<std::size_t> found;
  for (const Circle& square : sight.unknown()) {
    const double distance_m = (square.centre_m - at_m).norm();
    CHECK(distance_m >= last_m);
    last_m = distance_m;
    CHECK(square.radius_m == Approx(LaserSight::kUnknownCell_m / std::sqrt(2.0)));
    for (std::size_t i = 0; i < standing.size(); ++i)
      if (touch(square, standing[i])) found.insert(i);
  }
  CHECK(found == std::set<std::size_t>{0, 1});
}

TEST_CASE("after everything is forgotten, an earlier scan is used, and shows nothing of those before it") {
  Watched watched;
  LaserSight sight(watched.laser, watched.rules);
  const Circle standing{{1.02, 0}, 0.1};
  for (int i = 0; i < 10; ++i) REQUIRE(watched.scan(sight, {0, 0}, kBegin + i * kPeriod, {&standing, 1}));
  REQUIRE_FALSE(sight.unknown().empty());
  REQUIRE(sight.grid().state_at({0.92, 0}) == CellState::kOccupied);
  sight.forget();
  CHECK(sight.captured_at() == Time{});
  CHECK(sight.unknown().empty());
  const Circle far{{3, 0}, 0.1};
  REQUIRE(watched.scan(sight, {0, 0}, kBegin, {&far, 1}));
  CHECK(sight.grid().state_at({0.92, 0}) != CellState::kOccupied);
  CHECK(sight.tracks().empty());
  CHECK(sight.unknown().empty());
}

}  // namespace sidestep::laser_sight_test
