// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/scenario.hpp"
#include "common/config/yaml_map.hpp"

namespace sidestep {

/// Reads what is on the floor besides the robots: obstacles, opponents, the ball. Throws ScenarioError for
/// what is wrong.
void read_floor(YamlMap& map, Scenario& scenario);

}  // namespace sidestep
