// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `sidestep go`, `cancel`, `hold`, `resume`, `zone` and `status`, which give orders to robots while
/// they run.
void add_order_commands(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
