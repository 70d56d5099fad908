// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace sidestep {

// Faults of processes that tests (deploy/trial/test) and campaigns (deploy/trial/simulate/campaign) share.
// Processes have the same names as in reports: "agent 3", "agent 3 (twin)", "coordinator 1", "vision",
// "simulator". The plan states the time and the duration of each fault.

using ProcessNames = std::vector<std::string>;

struct Kill {
  std::string process;
};
/// Sends SIGSTOP, and SIGCONT at the end.
struct Pause {
  ProcessNames processes;
  /// On SimBus: maximum number of messages that are queued for each paused process, as in the buffer of a
  /// socket; further ones are lost.
  std::size_t max_queued = 1000;
};
/// Drops all messages from some processes to others. Lasts until the end if it has no duration.
struct Partition {
  ProcessNames from, to;
  bool is_two_way = false;  ///< also drops messages in the other direction
};

}  // namespace sidestep
