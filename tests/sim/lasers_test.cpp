// SPDX-License-Identifier: Apache-2.0
// Robots that see opponents and people only with their own lasers.
#include <algorithm>
#include <chrono>

#include "common/config/scenario_loader.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"
#include "tests/study/corners/corner_scene.hpp"
#include "tests/study/corners/doorway_scene.hpp"

namespace sidestep::lasers_test {

using namespace std::chrono_literals;

Scenario one_robot(const Vec2& start, const Vec2& goal) {
  Scenario scenario;
  scenario.name = "lasers";
  scenario.field = {9, 6};
  RobotSpec robot;
  robot.start_m = start;
  robot.goals = {{goal}};
  scenario.robots = {robot};
  scenario.laser.emplace();
  return scenario;
}

TEST_CASE(
    "no robot is moving when it collides with a person who steps out of a place hidden from its laser") {
  int arrived = 0, cases = 0;
  std::uint64_t touched_at_rest = 0;
  for (std::size_t kind = 0; kind < kCornerKinds.size(); ++kind) {
    for (std::uint64_t seed = 9'000'001; seed <= 9'000'008; ++seed) {
      CAPTURE(kCornerKinds[kind], seed);
      const CornerResult result = run_corner(corner_scene(kind, seed), seed, true);
      CHECK(result.contacts == 0);
      CHECK(result.crashes_in_motion == 0);
      CHECK(result.audit_passed);
      touched_at_rest += result.crashes;
      arrived += result.has_arrived;
      ++cases;
    }
  }
  CHECK(arrived > cases * 7 / 10);
  CHECK(touched_at_rest > 10);  // with fewer touches the test would prove little
}

TEST_CASE(
    "no robot is moving when it collides with a person who steps out of a doorway hardly wider than the "
    "person") {
  int arrived = 0, cases = 0;
  std::uint64_t touched_at_rest = 0;
  for (std::size_t kind = 0; kind < kDoorwayKinds.size(); ++kind) {
    for (std::uint64_t seed = 9'000'001; seed <= 9'000'006; ++seed) {
      CAPTURE(kDoorwayKinds[kind], seed);
      const CornerResult result = run_corner(doorway_scene(kind, seed), seed, true);
      CHECK(result.contacts == 0);
      CHECK(result.crashes_in_motion == 0);
      CHECK(result.audit_passed);
      touched_at_rest += result.crashes;
      arrived += result.has_arrived;
      ++cases;
    }
  }
  CHECK(arrived > cases / 2);
  CHECK(touched_at_rest > 10);
}

TEST_CASE("six robots drive safely among ten people whom they see only with their own lasers") {
  const Scenario scenario =
      load_scenario(std::string(SIDESTEP_SOURCE_DIR) + "/deploy/scenarios/house-laser.yaml");
  SimSystem system(scenario, 1);
  CHECK(system.run_until_arrived(system.begin() + 400s));
  const Report report = system.metrics().report();
  CHECK(report.arrived == 6);
  CHECK(report.contacts == 0);
  CHECK(report.crashes_while_moving == 0);
  CHECK(report.crashes > 0);
}

//   |  A  |     Through the gap A no speed is safe: a person may stand
//   |     |     right behind its edges. If there is a second, wider
//   o ->  * gap, the robot drives through that gap.
TEST_CASE("a robot avoids a blind corner where no speed is safe, or reports that it is blocked") {
  const bool has_other_way = GENERATE(false, true);
  CAPTURE(has_other_way);
  Scenario scenario = one_robot({-3, 0}, {3, 0});
  scenario.max_opponent_speed_mps = 2;
  scenario.laser->rate_hz = 10;
  const double other_low = has_other_way ? -2.8 : -3, other_high = has_other_way ? -0.7 : -3;
  scenario.obstacles = {Box{{-0.05, other_high}, {0.05, -0.2}}, Box{{-0.05, 0.2}, {0.05, 3}}};
  if (has_other_way) scenario.obstacles.emplace_back(Box{{-0.05, -3}, {0.05, other_low}});
  SimSystem system(scenario, 1);
  bool was_blocked = false;
  system.observer_bus().subscribe(topics::kOrderStatus, [&](const msg::OrderStatus& status) {
    if (status.block_reason() != msg::BlockReason::BLOCK_OCCLUDED_CORNER) return;
    was_blocked = true;
    CHECK(std::abs(status.blocker_x_m()) < 0.3);
    CHECK(std::abs(status.blocker_y_m()) < 0.5);
  });
  CHECK(system.run_until_arrived(system.begin() + 40s) == has_other_way);
  CHECK(was_blocked == !has_other_way);
  CHECK(system.metrics().report().contacts == 0);
}

TEST_CASE("a robot stops while its laser scans fail to arrive, and continues with the next scan") {
  const Scenario scenario = one_robot({-4, 0}, {4, 0});
  Scenario rarely = scenario;  // the laser's scan rate is not one of the rules that processes compare
  rarely.laser->rate_hz = 0.5;
  SimSystem system(scenario, 1);
  system.kill("simulator");
  system.use_scenario("simulator", rarely);
  system.restart("simulator");
  SimBus listener(system.network());
  listener.use_rules(SharedRules(scenario).fingerprint(), [](const auto&, const auto&) {});
  Time last_scan{};
  int scans = 0;
  listener.subscribe<msg::LaserScan>(topics::kScan, 0, [&](const msg::LaserScan&) {
    last_scan = system.now();
    ++scans;
  });
  bool has_stopped = false, has_gone_on = false;
  system.observer_bus().subscribe(topics::kTruth, [&](const msg::GroundTruth& truth) {
    if (truth.robots().empty() || scans == 0) return;
    const double speed_mps = std::hypot(truth.robots()[0].vx_mps(), truth.robots()[0].vy_mps());
    // The robot rests after 0.3 s without a scan, a few cycles, and the time to brake from 2 m/s.
    const bool is_late = system.now() - last_scan > 0.3s + 0.1s + 0.5s;
    if (is_late) CHECK(speed_mps < 0.05);
    has_stopped = has_stopped || is_late;
    has_gone_on = has_gone_on || (has_stopped && speed_mps > 0.5);
  });
  CHECK(system.run_until_arrived(system.begin() + 120s));
  CHECK(scans > 5);
  CHECK(has_stopped);
  CHECK(has_gone_on);
}

}  // namespace sidestep::lasers_test
