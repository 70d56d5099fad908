// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sidestep {

/// `sidestep-vision view`: takes images from a running system, reads them, and writes pictures of them with
/// what is seen in them. Returns the exit code.
int view_command(int argc, char** argv);

}  // namespace sidestep
