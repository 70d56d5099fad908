// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/protocol/negotiation_messages.hpp"

namespace sidestep {

/// Records the messages from the coordinator of the agent's epoch, and decides whether it serves the agent.
class CoordinatorContact {
 public:
  /// Forgets everything about the previous epoch.
  void on_epoch();
  /// Uses a heartbeat of the current epoch.
  void on_heartbeat(const CoordinatorHeartbeat& heartbeat, RobotId robot, Time now);
  /// Records that a request which the coordinator will answer has been sent.
  void on_request(Time now);
  /// Uses an answer of the current epoch.
  void on_verdict(const Verdict& verdict, Time now);

  /// Whether a heartbeat has arrived recently.
  bool is_heard(Time now) const;
  /// Whether a heartbeat has ever arrived.
  bool has_been_heard() const { return last_heartbeat_at_ != Time{}; }
  /// Whether the robot has not registered, according to the last heartbeat.
  bool is_robot_missing() const { return is_robot_missing_; }
  /// Whether the coordinator grants proposals, according to the last heartbeat.
  bool is_granting() const { return is_granting_; }
  /// Whether for too long the coordinator has sent no heartbeat, has not answered, or has not known which
  /// versions the robot executes.
  bool is_failing(Time now) const;

 private:
  Time last_heartbeat_at_{};
  bool is_robot_missing_ = false, is_granting_ = false;
  std::optional<Time> unanswered_since_;  // time of the first request since the last answer
  std::optional<Time> unknown_since_;     // since when the coordinator has not known the robot's versions
};

}  // namespace sidestep
