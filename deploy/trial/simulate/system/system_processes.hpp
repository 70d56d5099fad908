// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/motion/version.hpp"

namespace sidestep {

/// The names of the processes that a system starts: "simulator", "vision", "coordinator", "agent 3".
std::vector<std::string> system_process_names(const Scenario& scenario);
/// The process name of a robot's second agent.
std::string twin_process(RobotId robot);
/// The name of a second process of a kind that must run alone: "simulator" or "vision".
std::string second_process(const std::string& process);
/// The name of the process that a second one of its kind duplicates; for any other process, its own name.
std::string first_process(const std::string& process);

}  // namespace sidestep
