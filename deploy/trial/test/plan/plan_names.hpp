// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/yaml/yaml_map.hpp"
#include "deploy/trial/test/plan/expectation.hpp"

namespace sidestep {

// Readers for names and times that faults and expectations share. They throw ConfigError.

/// Returns the key that the mapping contains, which must be exactly one of these keys. `what`, for example "a
/// fault", appears in error messages.
[[nodiscard]] std::string only_key_of(YamlMap& map, const std::vector<std::string>& keys, const char* what);

/// Reads a robot of the scenario.
[[nodiscard]] RobotId robot_from(YamlMap& map, const std::string& key, const Scenario& scenario);
/// Reads "all", a robot, or a list of robots; nullopt if the key is missing.
[[nodiscard]] std::optional<RobotSet> find_robots(YamlMap& map, const std::string& key,
                                                  const Scenario& scenario);
/// The same under a required key.
[[nodiscard]] RobotSet robots_from(YamlMap& map, const std::string& key, const Scenario& scenario);

/// Reads one of these names; nullopt if the key is missing.
[[nodiscard]] std::optional<std::string> find_process(YamlMap& map, const std::string& key,
                                                      const std::vector<std::string>& names);
/// The same under a required key.
[[nodiscard]] std::string process_from(YamlMap& map, const std::string& key,
                                       const std::vector<std::string>& names);
/// Reads one or several of these names; nullopt if the key is missing.
[[nodiscard]] std::optional<std::vector<std::string>> find_processes(YamlMap& map, const std::string& key,
                                                                     const std::vector<std::string>& names);
/// The same under a required key.
[[nodiscard]] std::vector<std::string> processes_from(YamlMap& map, const std::string& key,
                                                      const std::vector<std::string>& names);

/// Reads a required number of seconds since the first grant, which must be within the scenario's time limit.
[[nodiscard]] double moment_from(YamlMap& map, const std::string& key, const Scenario& scenario);

}  // namespace sidestep
