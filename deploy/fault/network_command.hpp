// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace sidestep {

/// Adds `network` to `sidestep fault`: what becomes of messages inside processes that were started with
/// --faults.
void add_network_command(CLI::App& fault, std::function<int()>& action);

}  // namespace sidestep
