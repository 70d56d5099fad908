// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `sidestep report`, which shows the report of a run as text, as a page or as a picture.
void add_report_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
