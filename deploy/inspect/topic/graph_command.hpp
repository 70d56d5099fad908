// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `sidestep graph`, which shows the processes and topics of a domain.
void add_graph_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
