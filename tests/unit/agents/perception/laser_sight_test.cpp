// SPDX-License-Identifier: Apache-2.0
#include "agents/perception/laser_sight.hpp"

#include "tests/catch.hpp"

namespace sidestep::laser_sight_test {

/// The distance of the nearest frontier from a person who leans against a wall before the robot.
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

TEST_CASE("somebody who leans against a wall is not taken for the wall, however small and inexactly seen") {
  for (const double radius_m : {0.03, 0.05, 0.15})
    for (const double range_error_m : {0.0, 0.01})
      for (const double pose_error_m : {0.02, 0.07, 0.12}) {
        CAPTURE(radius_m, range_error_m, pose_error_m);
        CHECK(nearest_frontier_m(radius_m, range_error_m, pose_error_m) < range_error_m + 0.1);
      }
}

}  // namespace sidestep::laser_sight_test
