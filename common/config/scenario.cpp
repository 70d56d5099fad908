// SPDX-License-Identifier: Apache-2.0
#include "common/config/scenario.hpp"

#include <algorithm>

namespace sidestep {

SafetyBudget budget_of(const Scenario& scenario) {
  return {scenario.tracking_bound_m, scenario.clock_bound_s, scenario.limits.speed_mps};
}

const RobotSpec* find_robot(const Scenario& scenario, RobotId id) {
  const auto& robots = scenario.robots;
  const auto at = std::lower_bound(robots.begin(), robots.end(), id,
                                   [](const RobotSpec& robot, RobotId wanted) { return robot.id < wanted; });
  return at != robots.end() && at->id == id ? &*at : nullptr;
}

}  // namespace sidestep
