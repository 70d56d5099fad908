// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <string>

#include "common/config/scenario.hpp"
#include "common/messaging/bus.hpp"
#include "common/protocol/robot_messages.hpp"
#include "common/protocol/robot_observation.hpp"
#include "common/time/clock_offset.hpp"

namespace sidestep {

/// The position at which vision saw the robot, and the position prescribed by the version that it was
/// executing.
struct MotionSample {
  Time at{};        ///< time of the observation by this process's clock
  Time robot_at{};  ///< time of the observation by the robot's clock
  Vec2 seen_m{0, 0};
  Motion reference;
  VersionNumber executed = 0;  ///< the version that prescribed it
  bool is_off_reference = false;
};

/// Communicates with one robot as its agent would, without a coordinator: sends commands with pose fixes, and
/// receives the robot's reports and vision's observations. All times are by this process's clock unless
/// stated otherwise.
class RobotProbe {
 public:
  RobotProbe(Bus& bus, const Scenario& scenario, RobotId robot, Incarnation incarnation);
  RobotProbe(const RobotProbe&) = delete;
  RobotProbe& operator=(const RobotProbe&) = delete;

  /// The incarnation, epoch and version of all further commands.
  Incarnation incarnation;
  Epoch epoch;
  std::optional<Version> version;
  /// An error that is added to the fixes.
  Vec2 fix_error_m{0, 0};
  bool sends_commands = true;
  /// nullopt: the robot keeps the heading that it has.
  std::optional<double> desired_heading_rad;

  /// Sends the command of this cycle.
  void send_command();
  /// Sends a message unchanged and unchecked.
  void send(msg::Command message);

  const std::optional<RobotReport>& robot_report() const { return robot_report_; }
  /// When the last report arrived.
  Time report_at() const { return report_at_; }
  std::uint64_t report_count() const { return report_count_; }
  std::uint64_t malformed_reports() const { return malformed_reports_; }
  /// The longest interval between two reports since the last reset_gap().
  Duration longest_gap() const { return longest_gap_; }
  /// The longest interval between the times at which the robot made them. Where reports were lost, by their
  /// message numbers, it is the mean of the interval that they leave.
  Duration longest_gap_at_robot() const { return longest_gap_at_robot_; }
  /// Forgets the longest intervals and delays.
  void reset_gap() { longest_gap_ = longest_gap_at_robot_ = longest_command_delay_ = Duration{0}; }
  /// The longest interval between two reports of a robot that reports as often as it must.
  Duration max_gap() const;
  /// Why versions may have come too late since the last reset_gap(): this process, the robot's, or the
  /// network between them paused. nullopt if they were in time.
  std::optional<std::string> why_busy() const;
  const std::optional<RobotObservation>& seen() const { return seen_; }
  /// The heading at the time of seen(); nullopt if vision has not measured it.
  const std::optional<double>& seen_heading_rad() const { return seen_heading_rad_; }
  /// Bounds on how far the robot's clock is ahead of this process's clock; nullopt before the first exchange.
  std::optional<OffsetInterval> clock_offset() const { return clock_.at(bus_.now()); }
  Time now() const { return bus_.now(); }
  Time robot_now() const;

  /// Calls back with each sample once reports have shown which version was executed; null: no more callbacks.
  void on_sample(std::function<void(const MotionSample&)> callback) { on_sample_ = std::move(callback); }
  /// The version that the robot was executing at a time, according to its reports.
  const Version* executed_at(Time robot_time) const;

  RobotId robot() const { return robot_; }
  Duration cycle() const { return cycle_; }

 private:
  void on_robot_report(const msg::Feedback& message);
  void on_world_state(const msg::WorldState& message);
  void take_samples();
  /// Best estimate of how far the robot's clock is ahead of this process's clock.
  Duration robot_clock_offset() const;

  Bus& bus_;
  RobotId robot_;
  Duration cycle_;
  Writer<msg::Command> writer_;
  ClockOffset clock_;
  std::optional<RobotReport> robot_report_;
  Time report_at_{};
  std::uint64_t report_count_ = 0, malformed_reports_ = 0;
  std::uint64_t message_number_ = 0;  ///< of the last report
  Duration longest_gap_{0}, longest_gap_at_robot_{0}, longest_command_delay_{0};
  std::optional<RobotObservation> seen_;
  std::optional<double> seen_heading_rad_;
  std::optional<PoseFix> fix_;  ///< not sent yet
  struct Executed {
    Version version;
    bool is_off_reference = false;
  };
  std::deque<Executed> executed_;                      ///< in the order of the reports
  std::deque<RobotObservation> pending_observations_;  ///< until reports show what the robot was executing
  std::function<void(const MotionSample&)> on_sample_;
};

}  // namespace sidestep
