// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "common/motion/safety_budget.hpp"
#include "common/protocol/drop_counters.hpp"
#include "common/protocol/negotiation_messages.hpp"
#include "common/protocol/robot_messages.hpp"
#include "common/protocol/senders.hpp"
#include "common/time/clock_offset.hpp"
#include "idl/monitor.hpp"

namespace sidestep {

/// Measures the offsets of the robot's clock and of the coordinator's clock from the agent's own, using the
/// time stamps that their messages echo. Decides whether the safety budget allows the robot to move. That
/// decision does not depend on the agent's own clock, which may be arbitrarily wrong. All times here are by
/// the agent's own clock.
class ClockMonitor {
 public:
  /// Maximum age of a measurement. Older measurements are ignored, because clocks drift.
  static constexpr Duration kMaxMeasurementAge{2'000'000'000};

  ClockMonitor(const SafetyBudget& budget, double margin_m) : budget_(budget), margin_m_(margin_m) {}

  /// Uses the time stamp of a command that the robot echoes. A robot echoes commands of the agent that it
  /// obeys, so the echo is ignored unless that agent's incarnation is `own`.
  void on_robot_report(const RobotReport& robot_report, Incarnation own, Time received);
  /// Records the send time of a request that the coordinator will answer.
  void on_request_sent(Time sent);
  /// Starts a new epoch, which may belong to another coordinator with another clock. That clock has no
  /// measurement until the first verdict of the epoch shows which coordinator it is.
  void on_epoch(Epoch epoch);
  /// Uses the answer to a recorded request if it belongs to the current epoch.
  void on_verdict(const Verdict& verdict, Time received);

  /// Whether both clocks have recent measurements, and these are consistent with an offset within the bound.
  [[nodiscard]] bool allows_motion(Time now) const;
  /// The highest speed at which even the largest offset consistent with the measurements does not use up the
  /// margin. 0 without recent measurements; above every speed limit if the network is fast enough.
  [[nodiscard]] double max_speed_mps(Time now) const;
  /// The robot's maximum lag in excess of the clock bound, given the measured offsets. People and other
  /// bodies that do not negotiate come nearer in that time.
  [[nodiscard]] Duration max_lag(Time now) const;
  /// Whether recent measurements prove that the offset exceeds the bound.
  [[nodiscard]] bool is_beyond_bound(Time now) const;
  /// Whether the coordinator's clock should be measured again, before the last measurement becomes too old.
  [[nodiscard]] bool is_measurement_due(Time now) const;

  /// Estimated offset of the robot's clock from the agent's, positive if the robot's clock is ahead: the
  /// offset closest to zero that is consistent with the measurements. It is zero for clocks that agree.
  Duration robot_offset() const { return robot_offset_; }
  /// Whether there is a recent measurement of the robot's clock. A robot that is silent may have restarted
  /// with another time.
  bool is_robot_known(Time now) const { return robot_.at(now, kMaxMeasurementAge).has_value(); }
  /// Upper bound of the offset between the robot's clock and the agent's; robot_offset() if there is no
  /// recent measurement.
  Duration max_robot_offset(Time now) const;
  /// Offset between the robot's clock and the coordinator's; nullopt if it is unknown.
  std::optional<OffsetInterval> robot_coordinator_offset(Time now) const;
  void count_drops(DropCounters& drops) const {
    drops.count(DropReason::kImplausibleClock, std::nullopt, invalid_);
  }
  /// Fills in the clock fields of a status, and its state if the clocks forbid motion.
  void fill(msg::AgentStatus& status, Time now) const;

 private:
  struct CoordinatorClock {
    std::uint32_t sender = 0;
    Incarnation incarnation = 0;
    ClockOffset offset;  // relative to the agent's clock
  };
  Duration bound() const { return from_seconds(budget_.clock_bound_s); }
  /// Records when a message arrived. If this process's clock was set back, discards earlier exchanges.
  void arrived(Time received);
  /// Whether this process's clock has been set back since the last arrival.
  bool was_clock_set_back(Time now) const;
  /// The offset of the current epoch's coordinator; nullopt without a recent measurement.
  std::optional<OffsetInterval> coordinator_offset(Time now, Duration freshness) const;

  SafetyBudget budget_;
  double margin_m_;
  ClockOffset robot_;  // relative to the agent's clock
  Incarnation robot_incarnation_ = 0;
  std::array<CoordinatorClock, kMaxCoordinators> coordinators_;
  std::optional<std::size_t> coordinator_;  // the coordinator of epoch_; nullopt: it has not answered yet
  Epoch epoch_ = 0;
  Duration robot_offset_{0};
  // Send times of the latest requests; echoes of other time stamps are ignored.
  std::array<Time, 64> requests_{};
  std::size_t request_count_ = 0;
  Time latest_{};  // time of the latest arrival
  std::uint64_t invalid_ = 0;
};

}  // namespace sidestep
