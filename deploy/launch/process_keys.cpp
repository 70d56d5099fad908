// SPDX-License-Identifier: Apache-2.0
#include "deploy/launch/process_keys.hpp"

#include <algorithm>
#include <stdexcept>

#include "common/messaging/process_names.hpp"

namespace sidestep {

Identity identity_of_process(const std::string& process, const Scenario& scenario) {
  if (process == "robots") {
    const auto [first, last] = std::ranges::minmax(scenario.robots, {}, &RobotSpec::id);
    return {Role::kRobot, first.id, last.id};
  }
  if (const auto identity = parse_identity(process)) return *identity;
  throw std::logic_error("no identity for " + process);
}

void use_judge_keys(RunOptions& options, const Scenario& scenario) {
  if (options.keys.empty()) return;
  std::vector<std::string> processes{options.floor.driver.empty() ? "simulator" : "robots", "vision"};
  for (int number = 0; number < scenario.coordinators; ++number)
    processes.push_back(coordinator_process(number));
  for (const RobotSpec& robot : scenario.robots) processes.push_back(agent_process(robot.id));
  for (const std::string& process : processes)
    (void)key_folder_of(options.keys, identity_of_process(process, scenario));
  options.dds.keys = key_folder_of(options.keys, {Role::kJudge});
}

}  // namespace sidestep
