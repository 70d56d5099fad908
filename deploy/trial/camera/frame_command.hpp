// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `frame`, which renders a camera's view of a scenario at its start. Parsing it sets `action` to the
/// command, which returns the exit code, and may throw ConfigError for a file or std::runtime_error for any
/// other failure.
void add_frame_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
