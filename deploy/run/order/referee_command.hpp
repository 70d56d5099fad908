// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `sidestep referee`, which plays the referee of the Small Size League.
void add_referee_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
