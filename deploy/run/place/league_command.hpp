// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `sidestep league place`.
void add_league_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
