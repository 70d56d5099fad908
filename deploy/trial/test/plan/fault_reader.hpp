// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/yaml/yaml_map.hpp"
#include "deploy/trial/test/plan/planned_fault.hpp"

namespace sidestep {

inline constexpr std::size_t kMaxFaults = 1000;

/// Reads the key `faults` of a scenario file (deploy/scenarios/README.md). Paths in it are relative to
/// `folder`. Throws ConfigError.
[[nodiscard]] std::vector<PlannedFault> read_faults(YamlMap& map, const Scenario& scenario,
                                                    const std::string& folder);

}  // namespace sidestep
