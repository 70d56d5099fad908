// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds the command `bag`, which shows what recordings contain, extracts parts of them, and merges them.
void add_bag_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
