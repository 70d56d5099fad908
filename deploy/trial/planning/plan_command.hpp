// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `plan`. Parsing it sets `action`, which returns the exit code, and may throw ConfigError for a world
/// file or std::runtime_error with the reason for any other failure.
void add_plan_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
