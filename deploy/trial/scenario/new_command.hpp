// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `sidestep new`, which writes a scenario to start from.
void add_new_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
