// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace sidestep {

/// Adds to `sidestep fault` what somebody's hand does to a robot: push, slip, block, lift, place, reboot,
/// clock.
void add_robot_commands(CLI::App& fault, std::function<int()>& action);

}  // namespace sidestep
