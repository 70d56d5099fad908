// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds the commands for a single robot to `sidestep fault`: push, slip, block, lift, place, reboot, clock
/// and more.
void add_robot_commands(const CliCommand& fault, std::function<int()>& action);

}  // namespace sidestep
