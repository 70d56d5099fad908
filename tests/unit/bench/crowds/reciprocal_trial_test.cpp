// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/reciprocal_trial.hpp"

#include <limits>
#include <stdexcept>
#include <utility>

#include "tests/catch.hpp"

namespace sidestep::reciprocal_trial_test {

Scenario floor_with(std::initializer_list<std::pair<Vec2, Vec2>> starts_and_goals) {
  Scenario scenario;
  scenario.field = {6, 4};
  scenario.time_limit_s = 20;
  for (const auto& [start_m, goal_m] : starts_and_goals) {
    RobotSpec robot;
    robot.id = static_cast<RobotId>(scenario.robots.size());
    robot.start_m = start_m;
    robot.goals.push_back({goal_m});
    scenario.robots.push_back(robot);
  }
  return scenario;
}

ReciprocalSettings any_setting() {
  return GENERATE(from_range(reciprocal_settings().begin(), reciprocal_settings().end()));
}

TEST_CASE("a robot alone arrives hardly later than possible") {
  const ReciprocalSettings settings = any_setting();
  CAPTURE(settings.name);
  const CrowdResult result = run_reciprocal_avoidance(floor_with({{{-2, -1}, {2, 1}}}), settings, 1);
  REQUIRE(result.ratio);
  CHECK(*result.ratio < 1.05);
  CHECK(*result.ratio > 0.97);
  CHECK(result.arrived == 1);
  CHECK(result.cpu_us > 0);
  CHECK(result.contacts == 0);
}

TEST_CASE("two robots that meet head on pass each other without a contact") {
  const ReciprocalSettings settings = any_setting();
  CAPTURE(settings.name);
  const Scenario scenario = floor_with({{{-2, 0}, {2, 0}}, {{2, 0}, {-2, 0}}});
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    const CrowdResult result = run_reciprocal_avoidance(scenario, settings, seed);
    CHECK(result.arrived == 2);
    CHECK(result.contacts == 0);
    CHECK(result.ratio.value_or(9) < 1.3);
  }
}

TEST_CASE("a robot drives around a wall and not through it") {
  // start |  goal
  //       |
  const ReciprocalSettings settings = any_setting();
  CAPTURE(settings.name);
  Scenario scenario = floor_with({{{-1, 0.5}, {1, 0.5}}});
  scenario.obstacles = {GENERATE(Shape(Segment{{0, -0.5}, {0, 2}}), Shape(Box{{-0.05, -0.5}, {0.05, 2}}))};
  const CrowdResult result = run_reciprocal_avoidance(scenario, settings, 1);
  CHECK(result.arrived == 1);
  CHECK(result.contacts == 0);
  CHECK(result.violations == 0);
  // The straight line takes 1.53 s; the way around the wall is half as long again.
  CHECK(result.makespan_s.value_or(0) > 1.7);
}

TEST_CASE("a robot whose goal is behind a closed wall stays on its side") {
  const ReciprocalSettings settings = any_setting();
  CAPTURE(settings.name);
  Scenario scenario = floor_with({{{-1, 0}, {1, 0}}});
  scenario.obstacles = {Segment{{0, -2}, {0, 2}}};
  scenario.time_limit_s = 5;
  const CrowdResult result = run_reciprocal_avoidance(scenario, settings, 1);
  CHECK(result.arrived == 0);
  CHECK(result.contacts == 0);
  CHECK_FALSE(result.ratio);
  CHECK_FALSE(result.makespan_s);
}

TEST_CASE("a robot visits its goals in order and respects their speed limits") {
  Scenario scenario = floor_with({{{-2, 0}, {0, 0}}});
  scenario.robots[0].goals.push_back({{2, 0}});
  scenario.robots[0].goals.back().speed_limit_mps = 0.5;
  const CrowdResult result = run_reciprocal_avoidance(scenario, reciprocal_settings().front(), 1);
  CHECK(result.arrived == 1);
  // The first 2 m take at least 1.5 s, and the others 4 s.
  CHECK(result.makespan_s.value_or(0) > 5.5);
  CHECK(result.makespan_s.value_or(99) < 6);
}

TEST_CASE("the same seed gives the same reciprocal motion") {
  const Scenario scenario = floor_with({{{-2, 0}, {2, 0}}, {{2, 0}, {-2, 0}}, {{0, 1.5}, {0, -1.5}}});
  const ReciprocalSettings& settings = reciprocal_settings().front();
  const CrowdResult first = run_reciprocal_avoidance(scenario, settings, 7);
  const CrowdResult second = run_reciprocal_avoidance(scenario, settings, 7);
  REQUIRE(first.ratio);
  CHECK(first.ratio == second.ratio);
  CHECK(first.makespan_s == second.makespan_s);
}

TEST_CASE("a robot without a goal makes room and returns to its start") {
  Scenario scenario = floor_with({{{-2, 0}, {2, 0}}, {{0, 0.05}, {0, 0}}});
  scenario.robots[1].goals.clear();
  const CrowdResult result = run_reciprocal_avoidance(scenario, reciprocal_settings().front(), 1);
  CHECK(result.robots == 1);
  CHECK(result.arrived == 1);
  CHECK(result.contacts == 0);
}

TEST_CASE("reciprocal avoidance refuses scenes and settings that it cannot drive") {
  const Scenario scenario = floor_with({{{-2, 0}, {2, 0}}});
  const ReciprocalSettings settings = reciprocal_settings().front();
  Scenario opposed = scenario;
  opposed.opponents.push_back({});
  CHECK_THROWS_AS(run_reciprocal_avoidance(opposed, settings, 1), std::invalid_argument);
  Scenario absent = scenario;
  absent.robots[0].is_absent = true;
  CHECK_THROWS_AS(run_reciprocal_avoidance(absent, settings, 1), std::invalid_argument);
  ReciprocalSettings without_horizon = settings;
  without_horizon.time_horizon_s = 0;
  CHECK_THROWS_AS(run_reciprocal_avoidance(scenario, without_horizon, 1), std::invalid_argument);
  ReciprocalSettings unsound = settings;
  unsound.extra_radius_m = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(run_reciprocal_avoidance(scenario, unsound, 1), std::invalid_argument);
}

TEST_CASE("the benchmark tries five different settings of reciprocal avoidance") {
  const auto settings = reciprocal_settings();
  REQUIRE(settings.size() == 5);
  for (std::size_t i = 0; i < settings.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) CHECK(settings[i].name != settings[j].name);
}

}  // namespace sidestep::reciprocal_trial_test
