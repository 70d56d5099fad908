// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/config/scenario.hpp"

namespace sidestep {

/// Sentences about the goals of robots to which no free path leads, with the margin kept from obstacles. The
/// other robots and moving obstacles are ignored. nullopt if the floor has too many obstacles to decide it
/// within seconds.
[[nodiscard]] std::optional<std::vector<std::string>> unreachable_goals(const Scenario& scenario);

}  // namespace sidestep
