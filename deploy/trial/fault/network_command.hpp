// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `network` to `sidestep fault`: impairs the messages received by processes that were started with
/// --faults.
void add_network_command(const CliCommand& fault, std::function<int()>& action);

}  // namespace sidestep
