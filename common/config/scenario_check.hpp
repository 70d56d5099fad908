// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/config/scenario.hpp"

namespace sidestep {

/// Lines of a scenario file on which its robots stand, in the order of Scenario::robots.
struct RobotLines {
  int start = 1;
  std::vector<int> goals;  ///< one for each goal
};

/// Throws ScenarioError when robots share an id, or when a start or goal lies outside the field, in an
/// obstacle, or (starts among starts, last goals among last goals) where another robot's is, or when a start
/// lies where an opponent begins. Absent robots' starts are in nobody's way. `robots` are sorted by id.
void check_placement(const Scenario& scenario, const std::vector<RobotLines>& lines, const std::string& file);

}  // namespace sidestep
