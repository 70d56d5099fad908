// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sidestep {

/// `sidestep-vision replay FILE`: sends a log's packets with the timing with which they were received.
/// Returns the exit code: 1 when the file is corrupt, after the packets before the corruption have been sent.
int replay_command(int argc, char** argv);

/// `sidestep-vision record FILE`: records the league's multicast packets in a log until SIGINT or SIGTERM.
/// Returns the exit code.
int record_command(int argc, char** argv);

}  // namespace sidestep
