// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/messaging/impairment.hpp"
#include "common/protocol/robot_disturbance.hpp"

namespace sidestep {

// Processes have the same names as in reports: "agent 3", "agent 3 (twin)", "coordinator 1", "vision",
// "simulator".

/// The name for the coordinator that is granting when the fault begins.
inline constexpr const char* kActiveCoordinator = "active coordinator";

struct KillFault {
  std::string process;
};
/// Starts a process, killing it first if it is running.
struct RestartFault {
  std::string process;
  std::string scenario_file;  ///< scenario that it uses from then on; empty: the test's own
};
/// Sends SIGSTOP, and SIGCONT at the end.
struct PauseFault {
  std::string process;
};
/// Messages between two groups of processes are lost.
struct PartitionFault {
  std::vector<std::string> group, others;
  bool cuts_in = true;   ///< cuts messages from other processes to the group
  bool cuts_out = true;  ///< cuts messages from the group to other processes
};
/// Messages that arrive at a process are lost, delayed and duplicated.
struct ImpairmentFault {
  std::string target;  ///< a process, or "all"
  LinkQuality quality = kUnimpairedLink;
};
/// Starts a second agent of a robot.
struct TwinFault {
  RobotId robot = 0;
};
/// An operator attests that a robot that has not registered is not on the floor.
struct AbsenceFault {
  RobotId robot = 0;
};

using FaultAction = std::variant<KillFault, RestartFault, PauseFault, PartitionFault, ImpairmentFault,
                                 RobotDisturbance, TwinFault, AbsenceFault>;

/// A fault of a test, with its time.
struct PlannedFault {
  double at_s = 0;                ///< in seconds since the first grant
  std::optional<double> seconds;  ///< duration; nullopt: it has no end
  FaultAction action;
  std::string text;  ///< for messages, for example "kill agent 3"

  /// When the fault's effect ends.
  double end_s() const { return at_s + seconds.value_or(0); }
};

}  // namespace sidestep
