// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include "common/protocol/obstacle_bounds.hpp"
#include "common/random/rng.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"
#include "tests/sim/position_sampler.hpp"

namespace sidestep::opponents_test {

/// A few robots, and opponents on random routes with speeds up to the assumed maximum.
Scenario random_scene(std::uint64_t seed) {
  Rng rng(seed);
  Scenario scenario;
  scenario.name = "opponents";
  scenario.field = {6, 5};
  test::PositionSampler starts{rng, scenario.field, {}}, goals{rng, scenario.field, {}};
  const std::uint64_t robots = 3 + rng.below(6), opponents = 1 + rng.below(5);
  for (std::uint64_t i = 0; i < robots; ++i) {
    RobotSpec robot;
    robot.id = static_cast<RobotId>(i);
    robot.start_m = starts.sample(0.4);
    robot.goals = {{goals.sample(0.4), std::nullopt}};
    scenario.robots.push_back(robot);
  }
  for (std::uint64_t i = 0; i < opponents; ++i) {
    OpponentSpec opponent;
    opponent.radius_m = rng.uniform(0.06, 0.25);
    opponent.speed_mps = rng.chance(0.3) ? scenario.max_opponent_speed_mps : rng.uniform(0.2, 1.5);
    opponent.path_m.push_back(starts.sample(0.6));
    for (std::uint64_t k = 0; k < 1 + rng.below(3); ++k) opponent.path_m.push_back(starts.sample_any());
    scenario.opponents.push_back(opponent);
  }
  return scenario;
}

TEST_CASE("no robot is moving when a random opponent touches it, over a hundred seeds") {
  std::uint64_t crashes = 0;
  int robots = 0, arrived = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    CAPTURE(seed);
    const Scenario scenario = random_scene(seed);
    SimSystem system(scenario, seed);
    (void)system.run_until_arrived(system.begin() + from_seconds(20));
    const Report report = system.metrics().report();
    CHECK(report.contacts == 0);
    CHECK(report.crashes_while_moving == 0);
    CHECK(report.firmware_violations == 0);
    crashes += report.crashes;
    robots += report.robots;
    arrived += report.arrived;
  }
  CAPTURE(crashes, robots, arrived);
  WARN(arrived << " of " << robots << " robots arrived, " << crashes << " were touched at rest");
  // Without crashes the test would prove nothing; without arrivals robots that never move would pass.
  CHECK(crashes > 50);
  CHECK(arrived > robots / 2);
}

RobotSpec robot_with_goal(std::size_t index, const Vec2& start_m, const Vec2& goal_m) {
  RobotSpec robot;
  robot.id = static_cast<RobotId>(index);
  robot.start_m = start_m;
  robot.goals = {{goal_m, std::nullopt}};
  return robot;
}

/// Four robots cross the paths of four opponents at full speed. Fifty-six more opponents stand along the
/// sides, and come first or last in the scenario's list.
Scenario crowded_scene(std::uint64_t seed, bool standing_first) {
  Rng rng(seed);
  Scenario scenario;
  scenario.name = "sixty-opponents";
  scenario.field = {6, 5};
  for (std::size_t i = 0; i < 4; ++i) {
    const double y = -0.9 + 0.6 * static_cast<double>(i);
    scenario.robots.push_back(robot_with_goal(i, {-2.5, y}, {2.5, y}));
  }
  std::vector<OpponentSpec> standing, crossing;
  for (int i = 0; i < 28; ++i) {
    for (const double y : {-2.4, 2.4}) standing.push_back({0.08, 1, {{-2.8 + 0.2 * i, y}}});
  }
  for (int i = 0; i < 4; ++i) {
    const double x = -1.2 + 0.8 * i, y = rng.uniform(-1.5, 1.5);
    crossing.push_back({0.1, scenario.max_opponent_speed_mps, {{x, y}, {x, 1.6}, {x, -1.6}}});
  }
  const auto& first = standing_first ? standing : crossing;
  const auto& last = standing_first ? crossing : standing;
  scenario.opponents = first;
  scenario.opponents.insert(scenario.opponents.end(), last.begin(), last.end());
  return scenario;
}

TEST_CASE("none of sixty opponents touches a moving robot, whether listed in the scenario first or last") {
  const bool standing_first = GENERATE(true, false);
  std::uint64_t crashes = 0;
  int arrived = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(standing_first, seed);
    SimSystem system(crowded_scene(seed, standing_first), seed);
    (void)system.run_until_arrived(system.begin() + from_seconds(20));
    const Report report = system.metrics().report();
    CHECK(report.contacts == 0);
    CHECK(report.crashes_while_moving == 0);
    crashes += report.crashes;
    arrived += report.arrived;
  }
  CAPTURE(crashes, arrived);
  CHECK(crashes > 0);
  CHECK(arrived > 0);
}

TEST_CASE(
    "robots drive among more opponents than an obstacle list holds, and none is moving when it is touched") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Rng rng(seed);
  Scenario scenario;
  scenario.name = "six-hundred-opponents";
  scenario.field = {20, 20};
  scenario.vision.rows = 2;
  scenario.max_opponent_speed_mps = 0.5;
  test::PositionSampler places{rng, scenario.field, {}};
  for (std::size_t i = 0; i < 6; ++i) {
    const Vec2 start = places.sample(1), goal = places.sample_any();
    scenario.robots.push_back(robot_with_goal(i, start, goal));
  }
  for (int i = 0; i < 600; ++i) {
    OpponentSpec opponent{0.06, rng.uniform(0.1, 0.5), {places.sample(0.35)}};
    opponent.path_m.push_back(places.sample_any());
    scenario.opponents.push_back(opponent);
  }
  SimSystem system(scenario, seed);
  SimBus observer(system.network());
  observer.become_observer();
  int lists = 0, incomplete = 0;
  observer.subscribe(topics::kObstacles, [&](const msg::ObstacleList& list) {
    ++lists;
    if (list.obstacles().size() < msg::MAX_OBSTACLES || list.complete_within_m() >= kCompleteEverywhere_m)
      return;
    incomplete += list.complete_within_m() > 1;  // complete far enough to be useful
  });
  double longest_way_m = 0;
  system.observer_bus().subscribe(topics::kTruth, [&](const msg::GroundTruth& truth) {
    for (const msg::TrueRobotState& robot : truth.robots()) {
      const Vec2 way = Vec2(robot.x_m(), robot.y_m()) - scenario.robots.at(robot.robot()).start_m;
      longest_way_m = std::max(longest_way_m, way.norm());
    }
  });
  system.run_for(std::chrono::seconds(6));
  const Report report = system.metrics().report();
  CHECK(report.contacts == 0);
  CHECK(report.crashes_while_moving == 0);
  CHECK(lists > 300);
  CHECK(incomplete > lists / 2);
  CHECK(longest_way_m > 0.5);
}

}  // namespace sidestep::opponents_test
