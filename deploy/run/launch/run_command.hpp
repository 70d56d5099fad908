// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `sidestep run`. Parsing it sets `action`, which returns and throws what run() does.
void add_run_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
