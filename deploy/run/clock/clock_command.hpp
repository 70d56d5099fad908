// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `sidestep clock`, which shows the offsets of the processes' clocks.
void add_clock_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
