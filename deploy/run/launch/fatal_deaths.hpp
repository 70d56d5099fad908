// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <vector>

#include "deploy/audit/metrics/run_metrics.hpp"

namespace sidestep {

/// Whether the deaths of these processes prevent all robots from finishing what they have to do. Robots that
/// await orders have never finished.
[[nodiscard]] bool are_fatal(const std::set<std::string>& dead, int coordinators,
                             const std::vector<RobotProgress>& robots, bool awaits_orders);

}  // namespace sidestep
