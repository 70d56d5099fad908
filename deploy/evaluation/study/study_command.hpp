// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace sidestep {

/// Adds `study ...` to a program. When one of its commands is parsed, `action` becomes what is to be run; it
/// returns the exit code, and may throw std::runtime_error saying what fails.
void add_study_command(CLI::App& root, std::function<int()>& action);

}  // namespace sidestep
