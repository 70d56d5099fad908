// SPDX-License-Identifier: Apache-2.0
#include "common/config/scenario.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

#include "common/config/planner_names.hpp"

namespace sidestep {

FloorRules floor_rules(const Scenario& scenario) {
  return {scenario.field,    scenario.obstacles, scenario.limits,
          scenario.radius_m, scenario.margin_m,  scenario.map};
}

std::vector<RobotId> roster_of(const Scenario& scenario) {
  std::vector<RobotId> roster;
  for (const RobotSpec& robot : scenario.robots) roster.push_back(robot.id);
  return roster;
}

SafetyBudget budget_of(const Scenario& scenario) {
  return {scenario.tracking_bound_m, scenario.clock_bound_s, scenario.limits.speed_mps};
}

const RobotSpec* find_robot(const Scenario& scenario, RobotId id) {
  const auto& robots = scenario.robots;
  const auto at = std::lower_bound(robots.begin(), robots.end(), id,
                                   [](const RobotSpec& robot, RobotId wanted) { return robot.id < wanted; });
  return at != robots.end() && at->id == id ? &*at : nullptr;
}

const RobotSpec* find_robot(const Scenario& scenario, Team team, std::uint32_t number) {
  const auto at = std::find_if(scenario.robots.begin(), scenario.robots.end(), [&](const RobotSpec& robot) {
    return robot.team == team && number_in_team(robot.id) == number;
  });
  return at != scenario.robots.end() ? &*at : nullptr;
}

void require_unique_numbers(const Scenario& scenario) {
  for (const RobotSpec& robot : scenario.robots) {
    const RobotSpec* const first = find_robot(scenario, robot.team, number_in_team(robot.id));
    if (first->id == robot.id) continue;
    throw std::invalid_argument(fmt::format(
        "robots {} and {} both have number {} (the id modulo 16) in the {} team, expected different numbers",
        first->id, robot.id, number_in_team(robot.id), robot.team == Team::kBlue ? "blue" : "yellow"));
  }
}

void use_planner(Scenario& scenario, const std::string& planner) {
  if (planner.empty()) return;
  scenario.planner = planner;
  for (RobotSpec& robot : scenario.robots) robot.planner.clear();
}

}  // namespace sidestep
