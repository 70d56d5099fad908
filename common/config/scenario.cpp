// SPDX-License-Identifier: Apache-2.0
#include "common/config/scenario.hpp"

#include <algorithm>

namespace sidestep {

const RobotSpec* find_robot(const Scenario& scenario, RobotId id) {
  const auto& robots = scenario.robots;
  const auto at = std::lower_bound(robots.begin(), robots.end(), id,
                                   [](const RobotSpec& robot, RobotId wanted) { return robot.id < wanted; });
  return at != robots.end() && at->id == id ? &*at : nullptr;
}

}  // namespace sidestep
