// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sidestep {

/// `sidestep-vision calibrate SCENARIO FRAME...`: learns colours from pictures of a scenario's floor with
/// everything at its start position, and writes a file of thresholds.
/// `sidestep-vision calibrate --geometry POINTS`: calibrates cameras from points with known positions, and
/// writes a file of cameras. Returns the exit code.
int calibrate_command(int argc, char** argv);

}  // namespace sidestep
