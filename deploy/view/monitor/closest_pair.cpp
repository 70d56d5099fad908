// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor/closest_pair.hpp"

#include <algorithm>
#include <limits>

namespace sidestep {
std::optional<ClosestPair> closest_pair(std::vector<RobotPlace> robots, double radius_m, Time now) {
  std::ranges::sort(robots, {}, [](const RobotPlace& robot) { return robot.position_m.x(); });
  std::optional<ClosestPair> closest;
  double distance_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < robots.size(); ++i) {
    for (std::size_t j = i + 1; j < robots.size(); ++j) {
      if (robots[j].position_m.x() - robots[i].position_m.x() >= distance_m) break;
      const double d = (robots[j].position_m - robots[i].position_m).norm();
      if (d >= distance_m) continue;
      distance_m = d;
      closest = {d - 2 * radius_m, std::min(robots[i].id, robots[j].id), std::max(robots[i].id, robots[j].id),
                 now};
    }
  }
  return closest;
}

std::vector<RobotPlace> places_of(const FloorState& floor, Time now) {
  std::vector<RobotPlace> places;
  for (const auto& [id, robot] : floor.robots()) {
    if (robot.feedback && robot.feedback->value.is_lifted()) continue;
    if (const msg::TrueRobotState* truth = fresh(robot.truth, now))
      places.push_back({id, {truth->x_m(), truth->y_m()}});
    else if (const msg::TrackedRobot* seen = fresh(robot.seen, now))
      places.push_back({id, {seen->x_m(), seen->y_m()}});
  }
  std::erase_if(places, [](const RobotPlace& place) { return !place.position_m.allFinite(); });
  return places;
}

}  // namespace sidestep
