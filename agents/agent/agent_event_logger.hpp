// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "agents/agent/wait_reason.hpp"
#include "common/log/log_event.hpp"
#include "common/protocol/negotiation_messages.hpp"
#include "common/protocol/order.hpp"
#include "common/protocol/robot_messages.hpp"
#include "common/time/clock_offset.hpp"

namespace sidestep {

/// An agent's current activity, for its log.
struct AgentActivity {
  bool is_fenced = false;
  bool is_superseded = false;
  Incarnation incarnation = 0;
  bool is_registered = false;
  Epoch epoch = 0;  ///< 0: no epoch is known
  WaitReason waits_for = WaitReason::kNone;
  std::size_t goal_index = 0;
  bool has_arrived = false;  ///< the robot is at rest at its last goal
  bool is_recovering = false;
  bool is_escaping = false;
  std::optional<Blockage> stranger;  ///< the stranger that keeps the robot from driving
};

/// The speed limit that results from clock uncertainty, and the offset that causes it.
struct ClockSpeedLimit {
  double speed_mps = 0;
  double robot_limit_mps = 0;  ///< the robot's own limit
  std::optional<OffsetInterval> offset;
};

/// Logs changes of one agent's state. A condition that may change in every cycle is reported once it has
/// lasted for kSettlingTime, and at most once per kMinInterval.
class AgentEventLogger {
 public:
  static constexpr Duration kSettlingTime{250'000'000};
  static constexpr Duration kMinInterval{1'000'000'000};

  AgentEventLogger(const EventReporter& events, RobotId robot) : events_(events), robot_(robot) {}

  /// Call it once per cycle.
  void update(const AgentActivity& activity, const ClockSpeedLimit& limit, Time now);
  /// Processes a report of the robot's current incarnation.
  void on_robot_report(const RobotReport& robot_report);
  /// Logs that the agent has adopted an epoch announced by `coordinator` or, if nullopt, by its robot.
  void on_epoch(Epoch epoch, std::optional<std::uint32_t> coordinator);
  /// Processes the denial of a proposal.
  void on_denial(const Verdict& verdict);

 private:
  void report_protocol(const AgentActivity& activity);
  void report_motion(const AgentActivity& activity, Time now);
  void report_wait(WaitReason reason, Time now);
  void report_speed_limit(const ClockSpeedLimit& limit, Time now);
  void report_denials(Time now);
  void report_restart(std::uint64_t activated);

  const EventReporter& events_;
  const RobotId robot_;
  AgentActivity last_;
  // State for reports about waiting.
  WaitReason waits_for_ = WaitReason::kNone, reported_wait_ = WaitReason::kNone;
  Time waits_since_{};
  // State for reports about the speed limit.
  std::optional<Time> limited_since_, limit_reported_at_;
  double reported_limit_mps_ = 0;
  // State for reports about motion.
  std::optional<Time> escape_reported_at_, recovery_reported_at_, stranger_reported_at_;
  bool was_in_deadlock_ = false;
  // State from the robot's reports.
  Time latest_report_{};
  Incarnation robot_incarnation_ = 0;
  bool was_off_reference_ = false, was_lifted_ = false;
  VersionNumber own_stop_ = 0;
  std::uint64_t activated_ = 0;
  // Number of denials since the last report, by reason.
  std::array<std::uint64_t, static_cast<std::size_t>(msg::Reason::REASON_HELD) + 1> denials_{};
  std::uint64_t denial_count_ = 0;
  RobotId blocker_ = 0;  // the other robot in the latest conflict
  Time denials_reported_at_{};
};

}  // namespace sidestep
