// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sidestep {

/// `sidestep-vision replay FILE`: sends a log's packets with their original timing. Returns the exit code: 1
/// if the file is corrupt, after sending the packets before the corruption.
int replay_command(int argc, char** argv);

/// `sidestep-vision record FILE`: records the league's multicast packets in a log until SIGINT or SIGTERM.
/// Returns the exit code.
int record_command(int argc, char** argv);

}  // namespace sidestep
