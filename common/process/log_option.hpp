// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/log/log_level.hpp"
#include "common/process/command_line.hpp"

namespace sidestep {

/// Requires the name of a log level.
[[nodiscard]] ValueCheck log_level_names();
/// Adds --log-level. `level` keeps its value if the option is absent.
Option add_log_option(const CliCommand& app, LogLevel& level);

}  // namespace sidestep
