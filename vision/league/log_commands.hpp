// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `sidestep-vision replay FILE`, which sends a log's packets with their original timing; it exits with
/// 1 if the file is corrupt, after sending the packets before the corruption. And `sidestep-vision record
/// FILE`, which records the league's multicast packets in a log until SIGINT or SIGTERM.
void add_log_commands(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
