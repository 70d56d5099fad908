// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace sidestep {

/// Adds `topic list|hz|echo` to a program. When one of them is parsed, `action` becomes what is to be run; it
/// returns the exit code, and may throw std::runtime_error.
CLI::App* add_topic_command(CLI::App& root, std::function<int()>& action);

}  // namespace sidestep
