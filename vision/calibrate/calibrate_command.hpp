// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sidestep {

/// `sidestep-vision calibrate SCENARIO FRAME...`: learns colours from pictures of a scenario's floor on which
/// everything stands where it starts, and writes a file of thresholds. Returns the exit code.
int calibrate_command(int argc, char** argv);

}  // namespace sidestep
