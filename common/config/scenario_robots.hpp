// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/scenario.hpp"
#include "common/yaml/yaml_map.hpp"

namespace sidestep {

/// Reads the keys "robots", "circle", "disc" and "streams", and checks starts and goals against the field,
/// the obstacles and each other. Precondition: the rest of the scenario has been read. Throws ConfigError.
void read_robots(YamlMap& map, Scenario& scenario);

}  // namespace sidestep
