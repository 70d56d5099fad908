// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds the command `bag`: what is in recordings, parts of them, and several of them as one.
void add_bag_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
