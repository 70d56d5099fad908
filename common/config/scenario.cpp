// SPDX-License-Identifier: Apache-2.0
#include "common/config/scenario.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

#include "common/config/planner_names.hpp"

namespace sidestep {

FloorRules floor_rules(const FloorSpec& floor) {
  return {floor.field, floor.obstacles, floor.limits, floor.radius_m, floor.margin_m, floor.map};
}

std::vector<RobotId> roster_of(const FloorSpec& floor) {
  std::vector<RobotId> roster;
  for (const RobotSpec& robot : floor.robots) roster.push_back(robot.id);
  return roster;
}

SafetyBudget budget_of(const FloorSpec& floor) {
  return {floor.tracking_bound_m, floor.clock_bound_s, floor.limits.speed_mps};
}

const RobotSpec* find_robot(const FloorSpec& floor, RobotId id) {
  const auto& robots = floor.robots;
  const auto at = std::lower_bound(robots.begin(), robots.end(), id,
                                   [](const RobotSpec& robot, RobotId wanted) { return robot.id < wanted; });
  return at != robots.end() && at->id == id ? &*at : nullptr;
}

const RobotSpec* find_robot(const FloorSpec& floor, Team team, std::uint32_t number) {
  const auto at = std::find_if(floor.robots.begin(), floor.robots.end(), [&](const RobotSpec& robot) {
    return robot.team == team && number_in_team(robot.id) == number;
  });
  return at != floor.robots.end() ? &*at : nullptr;
}

void require_unique_numbers(const FloorSpec& floor) {
  for (const RobotSpec& robot : floor.robots) {
    const RobotSpec* const first = find_robot(floor, robot.team, number_in_team(robot.id));
    if (first->id == robot.id) continue;
    throw std::invalid_argument(fmt::format(
        "robots {} and {} both have number {} (the id modulo 16) in the {} team, expected different numbers",
        first->id, robot.id, number_in_team(robot.id), robot.team == Team::kBlue ? "blue" : "yellow"));
  }
}

void use_planner(FloorSpec& floor, const std::string& planner) {
  if (planner.empty()) return;
  floor.planner = planner;
  for (RobotSpec& robot : floor.robots) robot.planner.clear();
}

}  // namespace sidestep
