// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/crowd_reference.hpp"

#include <cmath>
#include <string>

#include "tests/bench/crowds/crowd_families.hpp"
#include "tests/catch.hpp"

namespace sidestep::crowd_reference_test {

NeighbourhoodSettings quick() {
  NeighbourhoodSettings settings;
  settings.orders = 1;
  settings.states = 10'000;
  return settings;
}

Scenario scene(const std::string& family, std::uint64_t seed) {
  return crowd_scene(*find_crowd_family(family), seed);
}

/// Two robots that are not in each other's way.
Scenario two_robots() {
  Scenario scenario;
  scenario.field = {4, 2};
  scenario.robots.resize(2);
  scenario.robots[0].start_m = {-1.5, 0.5};
  scenario.robots[0].goals.push_back({{1.5, 0.5}});
  scenario.robots[1].id = 1;
  scenario.robots[1].start_m = {1.5, -0.5};
  scenario.robots[1].goals.push_back({{-1.5, -0.5}});
  return scenario;
}

TEST_CASE("an independent check finds no fault in the reference, which is never below the bound") {
  for (const char* family : {"obstacle-lanes", "doorway", "corridor", "crossing-streams", "mixed-speeds"}) {
    CAPTURE(family);
    const Scenario scenario = scene(family, 2);
    const CrowdResult result = crowd_result_of(scenario, plan_reference(scenario, 1, quick()));
    CHECK(result.robots == static_cast<int>(scenario.robots.size()));
    CHECK(result.arrived == result.robots);
    CHECK(result.contacts + result.violations == 0);
    REQUIRE(result.ratio);
    CHECK(*result.ratio >= lower_bound_ratio(scenario) - 1e-6);
    CHECK(*result.ratio < lower_bound_ratio(scenario) + 0.5);
    CHECK(result.makespan_s.value_or(0) > 1);
  }
}

TEST_CASE("a plan with overlapping robots counts as a violation") {
  Scenario scenario = two_robots();
  const JointPlan plan = plan_reference(scenario, 1, quick());
  CHECK(crowd_result_of(scenario, plan).violations == 0);
  scenario.radius_m = 0.6;
  CHECK(crowd_result_of(scenario, plan).violations == 1);
}

TEST_CASE("a plan in which a robot exceeds the speed limit of its goal counts as a violation") {
  Scenario scenario = two_robots();
  const JointPlan fast = plan_reference(scenario, 1, quick());
  scenario.robots[1].goals[0].speed_limit_mps = 1;
  CHECK(crowd_result_of(scenario, fast).violations == 1);
  CHECK(crowd_result_of(scenario, plan_reference(scenario, 1, quick())).violations == 0);
}

TEST_CASE("robots with a free way reach the bound") {
  const Scenario scenario = two_robots();
  CHECK(lower_bound_ratio(scenario) == Approx(1).margin(1e-6));
  const CrowdResult result = run_reference(scenario, 1);
  CHECK(result.ratio.value_or(0) == Approx(1).margin(1e-6));
  CHECK(result.cpu_us > 0);
}

TEST_CASE("obstacles raise the bound, and speed limits of robots do not") {
  Scenario scenario = two_robots();
  scenario.obstacles.emplace_back(Circle{{0, 0.5}, 0.2});
  const double around = lower_bound_ratio(scenario);
  CHECK(around > 1.005);
  scenario.robots[1].goals[0].speed_limit_mps = 1;
  CHECK(lower_bound_ratio(scenario) == Approx(around).margin(1e-6));
  scenario.obstacles.emplace_back(Box{{-0.1, -1}, {0.1, 1}});
  CHECK(std::isinf(lower_bound_ratio(scenario)));
  CHECK(run_reference(scenario, 1).arrived == 0);
}

TEST_CASE("the reference refuses scenes that it cannot plan") {
  Scenario with_opponent = two_robots();
  with_opponent.opponents.emplace_back();
  CHECK_THROWS_AS(run_reference(with_opponent, 1), std::invalid_argument);
  CHECK_THROWS_AS(lower_bound_ratio(with_opponent), std::invalid_argument);
  Scenario without_goal = two_robots();
  without_goal.robots[1].goals.clear();
  CHECK_THROWS_AS(plan_reference(without_goal, 1), std::invalid_argument);
}

}  // namespace sidestep::crowd_reference_test
