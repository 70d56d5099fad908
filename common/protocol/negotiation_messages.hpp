// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include "common/motion/version_set.hpp"
#include "idl/negotiation.hpp"

namespace sidestep {

/// Agent to coordinator; see Proposal in idl/negotiation.idl. All candidates have the same robot, base and
/// start.
struct Proposal {
  RobotId robot = 0;
  Incarnation incarnation = 0;  ///< the agent's incarnation
  Epoch epoch = 0;
  Time sent_at{};                   ///< by the agent's clock
  VersionNumber number = 0;         ///< number of the first candidate, even if malformed; the proposal's id
  std::size_t candidate_count = 0;  ///< 0: the proposal is malformed
  /// In order of preference. nullopt: the candidate is malformed. Only the first candidate_count are used.
  std::array<std::optional<Version>, msg::MAX_CANDIDATES> candidates{};
};

/// Coordinator to one agent; see Verdict in idl/negotiation.idl.
struct Verdict {
  std::uint32_t sender = 0;
  Incarnation incarnation = 0;  ///< the coordinator's incarnation
  RobotId robot = 0;
  Epoch epoch = 0;
  Time sent_at{};                     ///< by the coordinator's clock
  VersionNumber proposal_number = 0;  ///< 0: answers a registration
  Time request_sent_at{};             ///< send time of the answered message, by the agent's clock
  VersionNumber granted_version = 0;  ///< 0: none
  std::array<msg::Reason, msg::MAX_CANDIDATES> reasons{};
  std::array<RobotId, msg::MAX_CANDIDATES> blockers{};  ///< valid if the reason is REASON_CONFLICT
};

/// Agent to coordinator after a change of epoch; see Registration in idl/negotiation.idl.
struct Registration {
  RobotId robot = 0;
  Incarnation incarnation = 0;  ///< the agent's incarnation
  Epoch epoch = 0;
  Time sent_at{};  ///< by the agent's clock
  /// All versions that the robot may execute, now or later. Empty: the robot is absent. nullopt: malformed,
  /// or asks_for_orders.
  std::optional<VersionSet> versions{};
  /// The robot has executed a granted version, or it obeyed another epoch before it obeyed this agent.
  bool has_moved = false;
  bool knows_orders = false;     ///< the agent knows all orders
  bool asks_for_orders = false;  ///< the message registers no robot but asks for all orders
};

/// The part of a CoordinatorState that agents and other coordinators use.
struct CoordinatorHeartbeat {
  std::uint32_t sender = 0;
  Incarnation incarnation = 0;
  Epoch epoch = 0;  ///< 0: the coordinator is a standby
  msg::CoordinatorMode mode = msg::CoordinatorMode::COORDINATOR_STANDBY;
  /// Time of the last world state that the coordinator has compared with the robots' versions.
  Time watched_until{};
  bool remembers_orders = false;
  std::span<const msg::RobotNotice> notices{};  ///< valid during the lifetime of the decoded message
};

/// Whether a robot's future motion is unknown, so it counts as a moving obstacle.
inline bool is_uncontrolled(const msg::RobotNotice& notice) {
  return notice.is_displaced() || notice.is_silent();
}

/// Whether a robot has not registered with the coordinator.
inline bool is_missing(const CoordinatorHeartbeat& heartbeat, RobotId robot) {
  return std::ranges::any_of(heartbeat.notices, [=](const msg::RobotNotice& notice) {
    return notice.robot() == robot && notice.is_missing();
  });
}

}  // namespace sidestep
