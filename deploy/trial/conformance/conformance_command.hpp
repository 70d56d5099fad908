// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `sidestep conformance SCENARIO`, which tests the scenario's only robot over DDS.
void add_conformance_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
