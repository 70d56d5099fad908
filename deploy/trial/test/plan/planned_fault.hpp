// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "common/messaging/impairment.hpp"
#include "common/protocol/robot_disturbance.hpp"
#include "deploy/trial/fault/fault_schedule.hpp"
#include "deploy/trial/fault/process_faults.hpp"

namespace sidestep {

/// The name for the coordinator that is granting when the fault begins.
inline constexpr const char* kActiveCoordinator = "active coordinator";

/// Starts a process, killing it first if it is running.
struct RestartFault {
  std::string process;
  std::string scenario_file;  ///< scenario of the restarted process; empty: the test's own
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

using FaultAction = std::variant<Kill, RestartFault, Pause, Partition, ImpairmentFault, RobotDisturbance,
                                 TwinFault, AbsenceFault>;

/// A fault of a test, with its time.
struct PlannedFault {
  double at_s = 0;                ///< in seconds since the first grant
  std::optional<double> seconds;  ///< duration; nullopt: it has no end
  FaultAction action;
  std::string text;  ///< for messages, for example "kill agent 3"

  /// When the fault's effect ends.
  double end_s() const { return at_s + seconds.value_or(0); }
  FaultSpan span() const {
    return {from_seconds(at_s), seconds ? std::optional(from_seconds(end_s())) : std::nullopt};
  }
};

}  // namespace sidestep
