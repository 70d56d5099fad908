// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `sidestep topic` and its subcommands. Parsing one of them sets `action`, which returns the exit code
/// and may throw std::runtime_error.
void add_topic_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
