// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/rule_mutations.hpp"

#include <algorithm>

namespace sidestep {

const std::vector<RuleMutation>& rule_mutations() {
  static const std::vector<RuleMutation> rules{
      {"robots.yellow",
       [](Scenario& s) {
         const auto is_yellow = [](const RobotSpec& robot) { return robot.team == Team::kYellow; };
         s.robots.erase(std::ranges::find_if(s.robots, is_yellow));
       },
       true},
      {"robots.blue",
       [](Scenario& s) {
         const auto is_blue = [](const RobotSpec& robot) { return robot.team == Team::kBlue; };
         s.robots.erase(std::ranges::find_if(s.robots, is_blue));
       },
       true},
      {"radius_m", [](Scenario& s) { s.radius_m *= 0.9; }},
      {"margin_m", [](Scenario& s) { s.margin_m *= 2; }},
      {"tracking_bound_m", [](Scenario& s) { s.tracking_bound_m *= 0.7; }},
      {"clock_bound_s", [](Scenario& s) { s.clock_bound_s *= 0.2; }},
      {"limits.speed_mps", [](Scenario& s) { s.limits.speed_mps *= 0.95; }},
      {"limits.acceleration_mps2", [](Scenario& s) { s.limits.acceleration_mps2 *= 0.7; }},
      {"limits.deceleration_mps2", [](Scenario& s) { s.limits.deceleration_mps2 *= 1.2; }},
      {"field.length_m", [](Scenario& s) { s.field.length_m += 1; }},
      {"field.width_m", [](Scenario& s) { s.field.width_m += 1; }},
      {"max_opponent_speed_mps", [](Scenario& s) { s.max_opponent_speed_mps *= 0.7; }},
      {"obstacles",
       [](Scenario& s) {
         s.obstacles.push_back(Circle{{0.5, 0.5}, 0.05});
       }},
      {"map", [](Scenario& s) {
         MapGrid grid;
         grid.resolution_m = 1;
         grid.columns = static_cast<int>(s.field.length_m) + 4,
         grid.rows = static_cast<int>(s.field.width_m) + 4;
         grid.origin_m = -0.5 * Vec2(grid.columns, grid.rows);
         s.map = std::make_shared<const FloorMap>(OccupancyMap(grid, BitGrid(grid.columns, grid.rows)));
       }}};
  return rules;
}

}  // namespace sidestep
