// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/process/help/command_info.hpp"

namespace CLI {
class App;
}  // namespace CLI

namespace sidestep {

/// The options and commands that were added to a command line. `path` includes the app's own name.
[[nodiscard]] CommandInfo command_info(const CLI::App& app, const std::string& path);

}  // namespace sidestep
