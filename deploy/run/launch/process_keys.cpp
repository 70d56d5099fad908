// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/process_keys.hpp"

#include "common/keys/key_folder.hpp"
#include "common/process/process_identity.hpp"
#include "common/protocol/process_names.hpp"

namespace sidestep {

std::string key_folder_of_process(const RunOptions& options, const std::string& process,
                                  const Scenario& scenario) {
  if (options.dds.keys.empty()) return {};
  return key_folder_of(options.dds.keys, identity_of_process(process_id(process).value(), scenario));
}

void require_keys(const RunOptions& options, const Scenario& scenario) {
  std::vector<std::string> processes{options.floor.driver.empty() ? "simulator" : "robots", "vision"};
  for (int number = 0; number < scenario.coordinators; ++number)
    processes.push_back(coordinator_process(number));
  for (const RobotSpec& robot : scenario.robots) processes.push_back(agent_process(robot.id));
  for (const std::string& process : processes) (void)key_folder_of_process(options, process, scenario);
}

}  // namespace sidestep
