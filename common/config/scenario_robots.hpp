// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/scenario.hpp"
#include "common/config/yaml_map.hpp"

namespace sidestep {

/// Reads the keys "robots" and "circle" and checks every start and goal against field, obstacles and each
/// other, so it comes after everything else in the scenario. Throws ScenarioError.
void read_robots(YamlMap& map, Scenario& scenario);

}  // namespace sidestep
