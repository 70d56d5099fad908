// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace sidestep {

/// Adds `plan` and `bench planning` to a program. When one of them is parsed, `action` becomes what is to be
/// run; it returns the exit code, and may throw ScenarioError for a world file or std::runtime_error saying
/// what fails.
void add_plan_commands(CLI::App& root, std::function<int()>& action);

}  // namespace sidestep
