// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/fatal_deaths.hpp"

#include <algorithm>

#include "common/protocol/process_names.hpp"

namespace sidestep {
namespace {

bool are_all_coordinators_dead(const std::set<std::string>& dead, int coordinators) {
  for (int number = 0; number < coordinators; ++number) {
    if (!dead.contains(coordinator_process(number))) return false;
  }
  return true;
}

}  // namespace

bool are_fatal(const std::set<std::string>& dead, int coordinators, const std::vector<RobotProgress>& robots,
               bool awaits_orders) {
  if (dead.empty()) return false;
  if (dead.contains("simulator") || dead.contains("robots") || dead.contains("vision") ||
      are_all_coordinators_dead(dead, coordinators))
    return true;
  return std::ranges::all_of(robots, [&](const RobotProgress& row) {
    return dead.contains(agent_process(row.robot)) || (row.is_done && !awaits_orders);
  });
}

}  // namespace sidestep
