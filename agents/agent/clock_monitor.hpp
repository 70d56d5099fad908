// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "common/motion/safety_budget.hpp"
#include "common/protocol/drop_counters.hpp"
#include "common/protocol/negotiation_messages.hpp"
#include "common/protocol/robot_messages.hpp"
#include "common/time/clock_offset.hpp"
#include "idl/monitor.hpp"

namespace sidestep {

/// Measures the offsets of the robot's clock and of the coordinator's clock from the agent's own, using the
/// time stamps that their messages echo. Decides whether the safety budget allows the robot to move. That
/// decision does not depend on the agent's own clock, which may be arbitrarily wrong. All times here are by
/// the agent's own clock.
class ClockMonitor {
 public:
  /// Older measurements are ignored, because clocks drift.
  static constexpr Duration kMaxMeasurementAge{2'000'000'000};

  ClockMonitor(const SafetyBudget& budget, double margin_m) : budget_(budget), margin_m_(margin_m) {}

  /// Uses the echoed stamp of a command. A robot echoes commands of the agent that it obeys, so the echo is
  /// ignored unless that agent's incarnation is `own`.
  void on_feedback(const Feedback& feedback, Incarnation own, Time received);
  /// Records the send time of a request that the coordinator will answer.
  void on_request_sent(Time sent);
  /// A new epoch belongs to another coordinator, with another clock.
  void on_epoch(Epoch epoch);
  /// Uses answers of the current epoch to recorded requests.
  void on_verdict(const Verdict& verdict, Time received);

  /// Both clocks have recent measurements, and an offset within the bound is consistent with them.
  [[nodiscard]] bool allows_motion(Time now) const;
  /// The speed at which the largest offset that is consistent with the measurements does not use up the
  /// margin; 0 without recent measurements. Above every speed limit if the network is quick enough.
  [[nodiscard]] double max_speed_mps(Time now) const;
  /// Recent measurements prove that the offset exceeds the bound.
  [[nodiscard]] bool is_beyond_bound(Time now) const;
  /// The coordinator's clock should be measured again, before the last measurement becomes too old.
  [[nodiscard]] bool is_measurement_due(Time now) const;

  /// Estimated offset of the robot's clock from the agent's, positive if the robot's clock is ahead: the
  /// offset closest to zero that is consistent with the measurements. It is zero for clocks that agree.
  Duration robot_offset() const { return robot_offset_; }
  /// Whether the robot's clock has ever been measured.
  bool knows_robot() const { return knows_robot_; }
  /// Upper bound of the offset of the robot's clock from the agent's; robot_offset() if there is no recent
  /// measurement.
  Duration max_robot_offset(Time now) const;
  /// Offset of the robot's clock from the coordinator's.
  std::optional<OffsetInterval> robot_coordinator_offset(Time now) const;
  void count_drops(DropCounters& drops) const {
    drops.count(DropReason::kImplausibleClock, std::nullopt, invalid_);
  }
  /// Fills in the clock fields of a status, and its state if the clocks forbid motion.
  void fill(msg::AgentStatus& status, Time now) const;

 private:
  Duration bound() const { return from_seconds(budget_.clock_bound_s); }
  /// The time of an arrival. If this process's clock was set back, earlier exchanges mean nothing.
  void arrived(Time received);
  /// Whether this process's clock has been set back since the last arrival.
  bool is_before_arrivals(Time now) const;

  SafetyBudget budget_;
  double margin_m_;
  ClockOffset robot_, coordinator_;  // offsets from the agent's clock
  Incarnation robot_incarnation_ = 0;
  Epoch epoch_ = 0;
  bool knows_robot_ = false;
  Duration robot_offset_{0};
  std::array<Time, 64> requests_{};  // send times of the latest requests: echoes of other stamps are ignored
  std::size_t request_count_ = 0;
  Time latest_{};  // arrival
  std::uint64_t invalid_ = 0;
};

}  // namespace sidestep
