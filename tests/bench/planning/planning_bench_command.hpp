// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `planning`. Parsing it sets `action`, which returns the exit code.
void add_planning_bench_command(const CliCommand& bench, std::function<int()>& action);

}  // namespace sidestep
