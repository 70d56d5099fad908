// SPDX-License-Identifier: Apache-2.0
#include "simulator/world/opponents.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/random/rng.hpp"
#include "simulator/world/world.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/random/normal_vector.hpp"
#include "tests/unit/simulator/world/commands.hpp"
#include "tests/unit/simulator/world/random_drive.hpp"

namespace sidestep::opponents_test {

using std::chrono::milliseconds;

const Time kBegin = time_from_ns(1'700'000'000'000'000'000);

Vec2 random_position(Rng& rng) {
  const double y = rng.uniform(-2, 2), x = rng.uniform(-2, 2);
  return {x, y};
}

// The position after a distance along a closed or reversed route, found by folding the distance.
Vec2 along(const std::vector<Vec2>& path_m, bool is_loop, double distance_m) {
  double length = 0;
  for (std::size_t i = 1; i < path_m.size(); ++i) length += (path_m[i] - path_m[i - 1]).norm();
  double left = std::fmod(distance_m, is_loop ? length : 2 * length);
  if (left > length) left = 2 * length - left;
  for (std::size_t i = 1; i < path_m.size(); ++i) {
    const double leg = (path_m[i] - path_m[i - 1]).norm();
    if (left <= leg)
      return leg > 0 ? Vec2(path_m[i - 1] + (path_m[i] - path_m[i - 1]) * (left / leg)) : path_m[i];
    left -= leg;
  }
  return path_m.back();
}

TEST_CASE("an opponent follows its route at constant speed, back and forth or in a loop") {
  const std::uint64_t seed = GENERATE(range<std::uint64_t>(1, 11));
  const bool is_loop = GENERATE(false, true);
  CAPTURE(seed, is_loop);
  Rng rng(seed);
  OpponentSpec spec{0.1, rng.uniform(0.2, 3), {}};
  for (std::uint64_t i = 0; i < 3 + seed % 3; ++i) spec.path_m.push_back(random_position(rng));
  if (is_loop) spec.path_m.push_back(spec.path_m.front());
  Opponents opponents(std::vector{spec}, 0.09, 2.5);
  for (int step = 1; step <= 20'000; ++step) {
    opponents.step({});
    const Vec2 expected = along(spec.path_m, is_loop, step * spec.speed_mps * kPhysicsStepSeconds);
    REQUIRE((opponents.discs()[0].centre_m - expected).norm() < 1e-6);
  }
}

TEST_CASE("an opponent with a single waypoint or coincident ones stays at rest") {
  const auto path_m = GENERATE(std::vector<Vec2>{{1, 2}}, std::vector<Vec2>{{1, 2}, {1, 2}},
                               std::vector<Vec2>{{1, 2}, {1, 2}, {1, 2}});
  Opponents opponents(std::vector{OpponentSpec{0.1, 1, path_m}}, 0.09, 2.5);
  for (int step = 0; step < 100; ++step) opponents.step({});
  CHECK((opponents.discs()[0].centre_m - Vec2(1, 2)).norm() < 1e-9);
}

// One opponent drives along y = 0 from -1 to 1 and back. Halfway it passes or hits a robot at rest, at
// `lateral_offset_m`.
Scenario crash_scene(double lateral_offset_m) {
  Scenario scenario = test::separated_robots(2);
  scenario.robots[0].start_m = Vec2(0, lateral_offset_m);
  scenario.robots[1].start_m = Vec2(0, 2);
  scenario.opponents = {{0.11, 1, {{-1, 0}, {1, 0}}}};
  return scenario;
}

TEST_CASE(
    "an opponent that hits a robot at rest counts as one crash at its own speed, and not as a contact") {
  World world(crash_scene(0), kBegin, 1);
  world.advance(kBegin + milliseconds(1900));
  msg::GroundTruth truth;
  world.fill(truth);
  CHECK(truth.crashes() == 1);
  CHECK(truth.crashes_while_moving() == 0);
  CHECK(truth.max_crash_speed_mps() == Approx(1).epsilon(0.01));
  CHECK(truth.max_robot_crash_speed_mps() < 0.02);
  CHECK(truth.contacts() == 0);
  CHECK((world.bodies()[0].position_m() - Vec2(0, 0)).norm() < 0.003);
  world.advance(kBegin + milliseconds(3900));
  CHECK(world.opponents().totals().crashes == 2);
}

TEST_CASE("crash speed is measured along the line of centres") {
  // Two discs with radii of 0.11 and 0.09 m and a lateral offset of 0.12 m touch when they are 0.16 m apart
  // along the route.
  World world(crash_scene(0.12), kBegin, 1);
  world.advance(kBegin + milliseconds(1900));
  CHECK(world.opponents().totals().crashes == 1);
  CHECK(world.opponents().totals().max_crash_speed_mps == Approx(0.8).epsilon(0.02));
}

TEST_CASE("a robot that hits an opponent counts as moving, and its speed is reported") {
  World world(crash_scene(0), kBegin, 1);
  Trajectory dash(kBegin + milliseconds(100), {{0, 0}, {0, 0}});
  dash.append(milliseconds(500), Vec2(-3, 0));
  append_stop(dash, 5);
  world.on_command(0, test::command_with({0, 1, 1, 0, dash}), kBegin);
  world.advance(kBegin + milliseconds(1200));
  const CrashTotals& totals = world.opponents().totals();
  CHECK(totals.crashes == 1);
  CHECK(totals.crashes_while_moving == 1);
  // Robot and opponent meet after covering 0.8 m together: 1 m/s t + 1.5 (t - 0.1)² = 0.8.
  const double t = (-(1 - 0.3) + std::sqrt(0.7 * 0.7 + 4 * 1.5 * (0.8 - 0.015))) / 3;
  const double robot = 3 * (t - 0.1);
  CHECK(totals.max_robot_crash_speed_mps == Approx(robot).epsilon(0.1));
  CHECK(totals.max_crash_speed_mps == Approx(1 + robot).epsilon(0.1));
}

TEST_CASE("an opponent does not crash into a lifted robot") {
  World world(crash_scene(0), kBegin, 1);
  RobotDisturbance lift;
  lift.kind = msg::DisturbanceKind::DISTURBANCE_LIFT;
  REQUIRE(world.disturb(0, lift, kBegin));
  world.advance(kBegin + milliseconds(1900));
  CHECK(world.opponents().totals().crashes == 0);
}

TEST_CASE("crashes agree with a check of every pair in every step") {
  const std::uint64_t seed = GENERATE(range<std::uint64_t>(1, 11));
  CAPTURE(seed);
  Rng rng(seed);
  const double radius_m = 0.09;
  std::vector<OpponentSpec> specs;
  for (int i = 0; i < 4; ++i) {
    OpponentSpec spec{rng.uniform(0.05, 0.4), rng.uniform(0.5, 3), {}};
    for (int k = 0; k < 3; ++k) spec.path_m.push_back(random_position(rng));
    specs.push_back(spec);
  }
  std::vector<Body> robots;
  for (int i = 0; i < 20; ++i) robots.emplace_back(random_position(rng), 0, BodySettings{});
  Opponents opponents(specs, radius_m, BodySettings{}.speed_mps);
  std::vector<bool> touching(specs.size() * robots.size());
  std::vector<Vec2> last(specs.size());
  CrashTotals expected;
  for (int step = 0; step < 5000; ++step) {
    for (Body& robot : robots) {
      const Vec2 home = -robot.position_m() - 0.5 * robot.velocity_mps();
      robot.step({home + 3 * normal_vector(rng), 0});
    }
    for (std::size_t i = 0; i < specs.size(); ++i) last[i] = opponents.discs()[i].centre_m;
    opponents.step(robots);
    for (std::size_t i = 0; i < specs.size(); ++i) {
      const Circle& disc = opponents.discs()[i];
      for (std::size_t k = 0; k < robots.size(); ++k) {
        const Vec2 apart = robots[k].position_m() - disc.centre_m;
        const double clearance = apart.norm() - disc.radius_m - radius_m;
        if (clearance > Opponents::kContactHysteresis_m) touching[i * robots.size() + k] = false;
        if (clearance >= 0 || touching[i * robots.size() + k]) continue;
        touching[i * robots.size() + k] = true;
        ++expected.crashes;
        expected.crashes_while_moving += robots[k].velocity_mps().norm() > Opponents::kAtRest_mps ? 1 : 0;
        const double own = -robots[k].velocity_mps().dot(apart.normalized());
        expected.max_robot_crash_speed_mps = std::max(expected.max_robot_crash_speed_mps, own);
        expected.max_crash_speed_mps =
            std::max(expected.max_crash_speed_mps,
                     own + (disc.centre_m - last[i]).dot(apart.normalized()) / kPhysicsStepSeconds);
      }
    }
  }
  CHECK(opponents.totals().crashes == expected.crashes);
  CHECK(opponents.totals().crashes_while_moving == expected.crashes_while_moving);
  CHECK(opponents.totals().max_robot_crash_speed_mps == Approx(expected.max_robot_crash_speed_mps));
  CHECK(opponents.totals().max_crash_speed_mps == Approx(expected.max_crash_speed_mps).epsilon(0.001));
  CHECK(expected.crashes > 20);
}

}  // namespace sidestep::opponents_test
