// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/scenario.hpp"
#include "common/yaml/yaml_map.hpp"

namespace sidestep {

/// Reads the obstacles, the map, the opponents and the ball. `cells`: see read_floor_map(). Throws
/// ConfigError.
void read_floor(YamlMap& map, const OccupancyMap* cells, Scenario& scenario);

}  // namespace sidestep
