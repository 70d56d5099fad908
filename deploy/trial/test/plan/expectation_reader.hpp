// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/config/scenario.hpp"
#include "common/yaml/yaml_map.hpp"
#include "deploy/trial/test/plan/expectation.hpp"
#include "deploy/trial/test/plan/planned_fault.hpp"

namespace sidestep {

/// Reads the optional key `expect` of a scenario file (deploy/scenarios/README.md). Throws ConfigError.
[[nodiscard]] std::vector<Expectation> read_expectations(YamlMap& map, const Scenario& scenario,
                                                         const std::vector<PlannedFault>& faults);

}  // namespace sidestep
