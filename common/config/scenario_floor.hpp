// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/scenario.hpp"
#include "common/config/yaml_map.hpp"

namespace sidestep {

/// Reads the obstacles, the opponents and the ball. Throws ConfigError.
void read_floor(YamlMap& map, Scenario& scenario);

}  // namespace sidestep
