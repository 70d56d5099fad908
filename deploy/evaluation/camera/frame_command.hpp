// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace sidestep {

/// Adds `frame`, which renders what a scenario's camera sees at the beginning. When it is parsed, `action`
/// becomes what is to be run; it returns the exit code, and may throw ScenarioError for a file or
/// std::runtime_error saying what fails.
void add_frame_command(CLI::App& root, std::function<int()>& action);

}  // namespace sidestep
