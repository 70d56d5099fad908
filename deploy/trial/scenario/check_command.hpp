// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `sidestep check`, which checks and draws scenarios.
void add_check_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
