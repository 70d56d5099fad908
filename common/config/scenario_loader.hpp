// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/config/scenario.hpp"
#include "common/yaml/config_error.hpp"

namespace sidestep {

class YamlMap;

inline constexpr double kMaxTimeLimit_s = 86400;

/// Reads and checks a scenario file (deploy/scenarios/README.md). Throws ConfigError.
[[nodiscard]] Scenario load_scenario(const std::string& path);

/// Parses and checks the text of a scenario file. `file_name` appears in error messages, and its stem is the
/// default name of the scenario. If `map_cells` is given, it replaces the file that the key `map` names.
[[nodiscard]] Scenario parse_scenario(const std::string& text, const std::string& file_name,
                                      const OccupancyMap* map_cells = nullptr);

/// Records the keys of scenario files, except those of `faults` and `expect`, in the schema of the map.
void describe_scenario(YamlMap& map);

}  // namespace sidestep
