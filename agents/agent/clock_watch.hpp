// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "common/motion/version.hpp"
#include "common/time/clock_offset.hpp"
#include "idl/monitor.h"
#include "idl/negotiation.h"
#include "idl/robot.h"

namespace sidestep {

/// Measures the robot's clock and the coordinator's against the agent's own by the echoes that their messages
/// carry, and says whether the safety budget allows the robot to move. The agent's own clock drops out of
/// that: it may show anything. All times here are by the agent's own clock.
class ClockWatch {
 public:
  /// Older measurements do not count: clocks drift.
  static constexpr Duration kFresh{2'000'000'000};

  /// `bound`: by how much a robot's clock may differ from the coordinator's.
  ClockWatch(RobotId robot, Duration bound) : robot_id_(robot), bound_(bound) {}

  /// The robot echoes commands of the agent that it obeys: the echo is of this agent's clock only if that is
  /// `own`.
  void on_feedback(const msg::Feedback& feedback, Incarnation own, Time received);
  /// Something was sent to the coordinator that it answers.
  void on_asked(Time sent);
  /// Another epoch is another coordinator, and another clock.
  void on_epoch(Epoch epoch);
  /// Counts answers of the current epoch to what was asked.
  void on_verdict(const msg::Verdict& verdict, Time received);

  /// Both clocks have been measured lately, and nothing proves that they differ by more than the bound.
  bool allows_motion(Time now) const;
  /// What has been measured lately proves that they differ by more.
  bool is_beyond_bound(Time now) const;
  /// The coordinator's clock should be measured again, before what is known is too old to count.
  bool is_measurement_due(Time now) const;

  /// How far the robot's clock is ahead of the agent's at least, below zero: behind. Zero unless the
  /// measurements prove another; so it is for two clocks that agree.
  Duration robot_ahead() const { return robot_ahead_; }
  /// How far it may be ahead at most; what robot_ahead() says while nothing is known.
  Duration robot_ahead_at_most(Time now) const;
  /// The robot's clock against the coordinator's.
  std::optional<OffsetInterval> robot_to_coordinator(Time now) const;
  /// Completes a status by what has been measured.
  void fill(msg::AgentStatus& status, Time now) const;

 private:
  RobotId robot_id_;
  Duration bound_;
  ClockOffset robot_, coordinator_;
  Incarnation robot_life_ = 0;
  Epoch epoch_ = 0;
  Duration robot_ahead_{0};
  std::array<Time, 64> asked_{};  // when; so that nobody else's echo counts
  std::size_t asked_count_ = 0;
  std::uint64_t invalid_ = 0;
};

}  // namespace sidestep
