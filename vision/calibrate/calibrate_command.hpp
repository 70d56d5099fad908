// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `sidestep-vision calibrate SCENARIO FRAME...`, which learns colours from pictures of a scenario's
/// floor with everything at its start position, and writes a file of thresholds; and `sidestep-vision
/// calibrate --geometry POINTS`, which calibrates cameras from points with known positions, and writes a file
/// of cameras.
void add_calibrate_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
