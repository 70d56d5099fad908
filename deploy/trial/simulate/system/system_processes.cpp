// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/system/system_processes.hpp"

#include <string_view>

#include "common/protocol/process_names.hpp"

namespace sidestep {
namespace {

constexpr std::string_view kSecond = " (second)";

}  // namespace

std::vector<std::string> system_process_names(const Scenario& scenario) {
  std::vector<std::string> names{"simulator", "vision"};
  for (int number = 0; number < scenario.coordinators; ++number) names.push_back(coordinator_process(number));
  for (const RobotSpec& robot : scenario.robots) names.push_back(agent_process(robot.id));
  return names;
}

std::string twin_process(RobotId robot) { return agent_process(robot) + " (twin)"; }

std::string second_process(const std::string& process) { return process + std::string(kSecond); }

std::string first_process(const std::string& process) {
  return process.ends_with(kSecond) ? process.substr(0, process.size() - kSecond.size()) : process;
}

}  // namespace sidestep
