// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/config/scenario.hpp"

namespace sidestep {

/// Parses a selection of a scenario's robots: "all", or numbers and ranges separated by commas, such as
/// "0-10,16". Throws std::invalid_argument with the reason.
[[nodiscard]] std::vector<RobotId> select_robots(const Scenario& scenario, const std::string& text);

}  // namespace sidestep
