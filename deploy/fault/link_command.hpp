// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace sidestep {

/// Adds `partition`, `link` and `heal` to `sidestep fault`: what the kernel does to the packets of a host
/// that this machine plays.
void add_link_commands(CLI::App& fault, std::function<int()>& action);

}  // namespace sidestep
