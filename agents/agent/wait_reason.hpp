// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace sidestep {

/// Why an agent proposes no motion, except to step aside. If several reasons apply, the first in this order
/// is reported.
enum class WaitReason : std::uint8_t {
  kNone,
  kNotFenced,            ///< the robot has not acknowledged this agent
  kSuperseded,           ///< the robot obeys a later agent
  kNoCoordinator,        ///< no coordinator is heard
  kEpochNotObeyed,       ///< the robot has not acknowledged the epoch
  kNotRegistered,        ///< the coordinator has not confirmed the registration
  kOthersNotRegistered,  ///< the coordinator does not grant yet
  kRobotSilent,          ///< the robot sends no reports
  kTooManyVersions,      ///< the robot may execute the maximum number of versions that can be tracked
  kEnding,               ///< the agent's process is asked to end
  kOrdersUnknown,        ///< no coordinator that remembers all orders has been heard
  kHeld,                 ///< an order holds the robot
  kNoOrder,              ///< the robot has no order
  kNotSeen,              ///< vision has lost the robot
  kSeenElsewhere,        ///< vision's latest observations of the robot are elsewhere
  kNoScan,               ///< no laser scan has arrived recently
  kNoObstacleList,       ///< no complete list of obstacles has arrived recently
  kNotWatched,           ///< the coordinator has received no world state recently
  kClockNotMeasured,     ///< the offset between the robot's clock and the coordinator's is unknown
  kClockOutOfBound,      ///< the clocks differ by more than the safety budget allows
};

constexpr const char* to_text(WaitReason reason) {
  switch (reason) {
    case WaitReason::kNone:
      return "nothing";
    case WaitReason::kNotFenced:
      return "the robot to acknowledge this agent";
    case WaitReason::kSuperseded:
      return "the robot, which obeys a later agent";
    case WaitReason::kNoCoordinator:
      return "a coordinator: no heartbeat arrives";
    case WaitReason::kEpochNotObeyed:
      return "the robot to acknowledge the epoch";
    case WaitReason::kNotRegistered:
      return "the coordinator to confirm the registration";
    case WaitReason::kOthersNotRegistered:
      return "other robots to register";
    case WaitReason::kRobotSilent:
      return "reports from the robot";
    case WaitReason::kTooManyVersions:
      return "a report that shows which versions the robot no longer executes";
    case WaitReason::kEnding:
      return "its own end, as soon as the robot rests";
    case WaitReason::kOrdersUnknown:
      return "a coordinator that remembers all orders";
    case WaitReason::kHeld:
      return "an order to resume: the robot is held";
    case WaitReason::kNoOrder:
      return "an order";
    case WaitReason::kNotSeen:
      return "vision to see the robot";
    case WaitReason::kSeenElsewhere:
      return "vision, which sees the robot at another place";
    case WaitReason::kNoScan:
      return "a scan of the robot's laser";
    case WaitReason::kNoObstacleList:
      return "a complete list of obstacles from vision";
    case WaitReason::kNotWatched:
      return "the coordinator to receive a world state";
    case WaitReason::kClockNotMeasured:
      return "a measurement of the clocks";
    case WaitReason::kClockOutOfBound:
      return "the clocks to agree: they differ by more than the bound";
  }
  return "?";
}

}  // namespace sidestep
