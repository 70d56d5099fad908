// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `plan` to a program. When it is parsed, `action` becomes what to run; that returns the exit code, and
/// may throw ConfigError for a world file, or std::runtime_error that says what failed.
void add_plan_command(const Command& root, std::function<int()>& action);

}  // namespace sidestep
