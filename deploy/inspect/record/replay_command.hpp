// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds the command `replay`: writes the messages of a recording to a DDS domain.
void add_replay_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
