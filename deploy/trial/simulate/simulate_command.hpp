// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `sidestep simulate`: one run, or a campaign over many seeds. Parsing it sets `action`, which returns
/// and throws what simulate() and run_campaign() do.
void add_simulate_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
