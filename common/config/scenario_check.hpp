// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/config/scenario.hpp"

namespace sidestep {

/// Line numbers of a robot's entries in the scenario file.
struct RobotLines {
  int start = 1;
  std::vector<int> goals;  ///< one line number per goal
};

/// Throws ConfigError if two robots share an id, a start or goal lies outside the field or in an obstacle,
/// two starts or two last goals overlap, or a start overlaps the first point of an opponent. The starts of
/// absent robots may overlap others. Precondition: the robots are sorted by id; `lines` is in the same order.
void check_placement(const Scenario& scenario, const std::vector<RobotLines>& lines, const std::string& file);

}  // namespace sidestep
