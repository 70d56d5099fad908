// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `sidestep fault`. Parsing one of its commands sets `action`, which returns the exit code and throws
/// std::runtime_error with the reason if the fault cannot be applied.
void add_fault_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
