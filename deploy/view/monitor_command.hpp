// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `sidestep monitor`, which shows a running system or a recording in the browser.
void add_monitor_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
