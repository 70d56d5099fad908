// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sidestep {

/// `sidestep-vision view`: receives images from a running system, runs detection on them, and writes
/// annotated pictures. Returns the exit code.
int view_command(int argc, char** argv);

}  // namespace sidestep
