// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sidestep {

/// `sidestep-vision replay FILE`: sends a log's packets again, as they were received. Returns the exit code;
/// 1 when the file is damaged, after what came before has been sent.
int replay_command(int argc, char** argv);

/// `sidestep-vision record FILE`: writes what comes from the league's multicast into a log until it is told
/// to stop. Returns the exit code.
int record_command(int argc, char** argv);

}  // namespace sidestep
