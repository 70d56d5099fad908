// SPDX-License-Identifier: Apache-2.0
#include "simulator/world/lasers.hpp"

#include <cmath>
#include <limits>
#include <map>

#include "tests/catch.hpp"

namespace sidestep::lasers_test {

const Time kBegin = time_from_ns(1'700'000'000'000'000'000);

/// Three robots, a wall, and a person.
Scenario scene(std::uint64_t seed) {
  Rng rng(seed);
  Scenario scenario;
  scenario.field = {9, 6};
  for (RobotId id = 0; id < 3; ++id) {
    RobotSpec robot;
    robot.id = 10 + id;
    robot.start_m = {-3 + 3.0 * id, rng.uniform(-2, 0)};
    robot.start_heading_rad = rng.uniform(-3, 3);
    scenario.robots.push_back(robot);
  }
  scenario.obstacles.emplace_back(Box{{-4, 1}, {4, 1.2}});
  scenario.opponents.push_back({0.25, 0.5, {{rng.uniform(-4, 4), 0.6}, {0, 0.6}}});
  scenario.laser.emplace();
  scenario.laser->settings = {180, 2 * std::numbers::pi, 0.05, 8};
  scenario.laser->range_error_m = 0.02;
  return scenario;
}

/// Slow reference: the distance along a ray to the nearest object, in steps of a millimetre.
double brute_force_range_m(const Scenario& scenario, const World& world, std::size_t robot,
                           double angle_rad) {
  const Body& body = world.bodies()[robot];
  const Vec2 direction(std::cos(angle_rad), std::sin(angle_rad));
  for (double range_m = 0; range_m <= scenario.laser->settings.max_range_m; range_m += 0.001) {
    const Vec2 p = body.position_m() + range_m * direction;
    bool is_hit = signed_distance(p, scenario.obstacles[0]) <= 0;
    for (const Circle& person : world.opponents().discs())
      is_hit = is_hit || (p - person.centre_m).norm() <= person.radius_m;
    for (std::size_t other = 0; other < world.robot_count(); ++other)
      is_hit =
          is_hit || (other != robot && (p - world.bodies()[other].position_m()).norm() <= scenario.radius_m);
    if (is_hit) return range_m;
  }
  return std::numeric_limits<double>::infinity();
}

TEST_CASE("robots scan in turn and see obstacles, people and other robots with bounded errors") {
  int hits = 0, misses = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    CAPTURE(seed);
    const Scenario scenario = scene(seed);
    World world(scenario, kBegin, seed);
    Lasers lasers(scenario, kBegin, seed);
    std::map<RobotId, int> scans;
    for (int i = 0; i < 9; ++i) {
      world.advance(lasers.next_scan());
      const std::size_t robot = lasers.next_robot();
      msg::LaserScan scan;
      REQUIRE(lasers.scan(world, scan));
      ++scans[scan.robot()];
      CHECK(scan.captured_at_ns() == to_ns(world.time()));
      CHECK(Vec2(scan.x_m() - world.bodies()[robot].position_m().x(),
                 scan.y_m() - world.bodies()[robot].position_m().y())
                .norm() < 0.005);
      REQUIRE(scan.ranges_m().size() == 180);
      for (int beam = 0; beam < 180; beam += 7) {
        const double angle_rad =
            world.bodies()[robot].heading_rad() + LaserScanner(scenario.laser->settings).beam_angle_rad(beam);
        const double expected_m = brute_force_range_m(scenario, world, robot, angle_rad);
        const auto range_m = static_cast<double>(scan.ranges_m()[static_cast<std::size_t>(beam)]);
        CAPTURE(i, beam, expected_m, range_m);
        if (std::isfinite(expected_m))
          CHECK(std::abs(range_m - expected_m) <= 0.02 + 0.002);
        else
          CHECK(range_m == expected_m);
        ++(std::isfinite(expected_m) ? hits : misses);
      }
    }
    CHECK(scans == std::map<RobotId, int>{{10, 3}, {11, 3}, {12, 3}});
  }
  CHECK(hits > 200);
  CHECK(misses > 50);
}

TEST_CASE("a robot off the floor does not scan and does not delay the scans of others") {
  const Scenario scenario = scene(1);
  World world(scenario, kBegin, 1);
  Lasers lasers(scenario, kBegin, 1);
  RobotDisturbance lift;
  lift.robot = 10;
  lift.kind = msg::DisturbanceKind::DISTURBANCE_LIFT;
  REQUIRE(world.disturb(0, lift, kBegin));
  msg::LaserScan scan;
  world.advance(lasers.next_scan());
  CHECK_FALSE(lasers.scan(world, scan));
  const Duration period = from_seconds(1 / scenario.laser->rate_hz);
  CHECK(lasers.next_scan() <= kBegin + period);
  world.advance(lasers.next_scan());
  CHECK(lasers.scan(world, scan));
  CHECK(scan.robot() == 11);
}

TEST_CASE("the range of a lost beam is NaN") {
  Scenario scenario = scene(1);
  scenario.laser->dropout_probability = 0.3;
  World world(scenario, kBegin, 1);
  Lasers lasers(scenario, kBegin, 1);
  int lost = 0;
  msg::LaserScan scan;
  for (int i = 0; i < 10; ++i) {
    world.advance(lasers.next_scan());
    REQUIRE(lasers.scan(world, scan));
    for (const float range_m : scan.ranges_m()) lost += std::isnan(range_m);
  }
  CHECK(lost > 400);
  CHECK(lost < 700);
}

}  // namespace sidestep::lasers_test
