// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

#include "common/motion/version.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// The operator's side of attesting that a robot is not on the floor: repeats the attestation until the
/// coordinator no longer awaits the robot.
class AttestationExchange {
 public:
  /// Longer than the period of participant announcements.
  static constexpr Duration kTimeout = std::chrono::seconds(5);
  static constexpr Duration kRepeat = std::chrono::milliseconds(200);

  enum class State { kPending, kAccepted, kTimedOut };

  AttestationExchange(RobotId robot, Time now) : robot_(robot), begun_(now), due_(now) {}

  /// `is_missing` means that the coordinator awaits the robot. Returns whether the attestation must be sent
  /// now. Call it at least a few times a second.
  [[nodiscard]] bool update(bool is_missing, Time now);

  RobotId robot() const { return robot_; }
  Time begun() const { return begun_; }
  State state() const { return state_; }
  /// Why the attestation has not been accepted.
  std::string reason() const;

 private:
  RobotId robot_;
  Time begun_, due_;
  bool was_missing_ = false;
  State state_ = State::kPending;
};

}  // namespace sidestep
