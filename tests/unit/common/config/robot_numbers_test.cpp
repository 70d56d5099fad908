// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include "common/config/scenario.hpp"
#include "tests/catch.hpp"

namespace sidestep::robot_numbers_test {

Scenario scenario_of(const std::vector<std::pair<RobotId, Team>>& robots) {
  Scenario scenario;
  for (const auto& [id, team] : robots) {
    RobotSpec robot;
    robot.id = id;
    robot.team = team;
    scenario.robots.push_back(robot);
  }
  return scenario;
}

TEST_CASE("a robot is found by its team and number") {
  const Scenario scenario = scenario_of({{3, Team::kBlue}, {16, Team::kYellow}, {19, Team::kYellow}});
  CHECK(number_in_team(3) == 3);
  CHECK(number_in_team(16) == 0);
  CHECK(number_in_team(1023) == 15);
  REQUIRE(find_robot(scenario, Team::kBlue, 3));
  CHECK(find_robot(scenario, Team::kBlue, 3)->id == 3);
  CHECK(find_robot(scenario, Team::kYellow, 3)->id == 19);
  CHECK(find_robot(scenario, Team::kYellow, 0)->id == 16);
  CHECK_FALSE(find_robot(scenario, Team::kBlue, 0));
  CHECK_FALSE(find_robot(scenario, Team::kBlue, 19));
}

TEST_CASE("two robots with the same number are rejected in one team and accepted in two teams") {
  CHECK_NOTHROW(require_unique_numbers(scenario_of({{3, Team::kBlue}, {19, Team::kYellow}})));
  CHECK_THROWS_AS(require_unique_numbers(scenario_of({{3, Team::kBlue}, {19, Team::kBlue}})),
                  std::invalid_argument);
  CHECK_THROWS_WITH(
      require_unique_numbers(scenario_of({{0, Team::kYellow}, {3, Team::kYellow}, {19, Team::kYellow}})),
      ContainsSubstring("robots 3 and 19 both have number 3") && ContainsSubstring("yellow"));
}

}  // namespace sidestep::robot_numbers_test
