// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `partition`, `link` and `heal` to `sidestep fault`: packet filters in the kernel for namespace hosts.
void add_link_commands(const CliCommand& fault, std::function<int()>& action);

}  // namespace sidestep
