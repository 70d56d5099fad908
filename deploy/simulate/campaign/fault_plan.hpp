// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/messaging/sim/links.hpp"
#include "common/protocol/robot_disturbance.hpp"

namespace sidestep {

using ProcessNames = std::vector<std::string>;

/// Sets the quality of the links between those of these processes that are on different hosts.
struct LinkChange {
  ProcessNames from, to;
  LinkQuality quality;
};
/// Drops all messages between these processes for a while.
struct Partition {
  ProcessNames from, to;
  Duration duration{0};
};
/// SIGSTOP and, after the duration, SIGCONT.
struct Pause {
  ProcessNames processes;
  Duration duration{0};
  std::size_t max_queued = 0;  ///< messages per process; further ones are lost
};
struct Kill {
  std::string process;
};
/// Starts a dead process, or a robot's second agent.
struct Start {
  std::string process;
};

using Fault = std::variant<LinkChange, Partition, Pause, Kill, Start, RobotDisturbance>;

struct TimedFault {
  Duration at{0};  ///< since the start of the run
  Fault fault;
};

/// All faults of one run. None occurs or persists after `healed_at`.
struct FaultPlan {
  std::vector<ProcessNames> hosts;                 ///< messages within a host are fast and never lost
  std::map<std::string, Duration> clocks;          ///< offsets from true time, by process
  std::vector<RobotId> robots_out_of_clock_bound;  ///< robots that must not move because of their clocks
  std::vector<TimedFault> faults;                  ///< sorted by time
  Duration healed_at{0};
};

/// A description with one line per host, clock and fault.
std::vector<std::string> to_lines(const FaultPlan& plan);

}  // namespace sidestep
