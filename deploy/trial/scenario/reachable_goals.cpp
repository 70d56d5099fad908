// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/scenario/reachable_goals.hpp"

#include <fmt/format.h>

#include "deploy/trial/planning/free_space.hpp"

namespace sidestep {
namespace {

/// All pairs of obstacles are compared.
constexpr std::size_t kMaxObstacles = 2000;

}  // namespace

std::optional<std::vector<std::string>> unreachable_goals(const Scenario& scenario) {
  PlanWorld world;
  world.obstacles = scenario.obstacles;
  if (scenario.map) {
    for (const Box& box : scenario.map->boxes_on(scenario.field)) world.obstacles.emplace_back(box);
  }
  if (world.obstacles.size() > kMaxObstacles) return std::nullopt;
  // Robots keep the margin from obstacles, but not from the edge of the field.
  world.radius_m = scenario.radius_m + scenario.margin_m;
  world.field = {scenario.field.length_m + 2 * scenario.margin_m,
                 scenario.field.width_m + 2 * scenario.margin_m};
  const FreeSpace space(world);
  std::vector<std::string> problems;
  for (const RobotSpec& robot : scenario.robots) {
    for (std::size_t i = 0; i < robot.goals.size(); ++i) {
      const Vec2& goal_m = robot.goals[i].position_m;
      if (space.connects(robot.start_m, goal_m)) continue;
      problems.push_back(
          fmt::format("robot {} cannot reach goals_m[{}], ({:g}, {:g}): no way there is {:g} m wide "
                      "(diameter and margins)",
                      robot.id, i, goal_m.x(), goal_m.y(), 2 * world.radius_m));
    }
  }
  return problems;
}

}  // namespace sidestep
