// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/motion/version.hpp"

namespace sidestep {

/// The name of a robot's agent in messages, reports and hosts: "agent 3".
inline std::string agent_process(RobotId robot) { return "agent " + std::to_string(robot); }

/// The name of a coordinator in messages, reports and hosts: "coordinator", "coordinator 1".
inline std::string coordinator_process(int number) {
  return number == 0 ? "coordinator" : "coordinator " + std::to_string(number);
}

}  // namespace sidestep
