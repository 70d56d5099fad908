// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `study`. Parsing one of its commands sets `action`, which returns the exit code and may throw
/// std::runtime_error with the reason of a failure.
void add_study_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
