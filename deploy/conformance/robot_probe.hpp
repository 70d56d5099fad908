// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <optional>

#include "common/config/scenario.hpp"
#include "common/messaging/bus.hpp"
#include "common/protocol/robot_messages.hpp"
#include "common/protocol/robot_observation.hpp"
#include "common/time/clock_offset.hpp"

namespace sidestep {

/// Where vision saw the robot, and where the version that it executed then should have taken it.
struct MotionSample {
  Time at{};        ///< by this process's clock
  Time robot_at{};  ///< by the robot's
  Vec2 seen_m{0, 0};
  Motion reference;
  bool is_off_reference = false;
};

/// Speaks to one robot as its agent would, without a coordinator: sends commands with fixes, and hears its
/// facts and what vision sees. All times are by this process's clock unless they say otherwise.
class RobotProbe {
 public:
  RobotProbe(Bus& bus, const Scenario& scenario, RobotId robot, Incarnation incarnation);
  RobotProbe(const RobotProbe&) = delete;
  RobotProbe& operator=(const RobotProbe&) = delete;

  /// The incarnation, epoch and version of the commands that are sent from now on.
  Incarnation incarnation;
  Epoch epoch;
  std::optional<Version> version;
  /// Added to the fixes.
  Vec2 fix_error_m{0, 0};
  bool sends_commands = true;

  /// Sends the command of this cycle.
  void send_command();
  /// Sends a message as it is, whatever is in it.
  void send(msg::Command message);

  const std::optional<Feedback>& fact() const { return fact_; }
  /// When it arrived.
  Time fact_at() const { return fact_at_; }
  std::uint64_t facts() const { return facts_; }
  std::uint64_t malformed_facts() const { return malformed_facts_; }
  /// The longest time between two facts since the last reset_gap().
  Duration longest_gap() const { return longest_gap_; }
  void reset_gap() { longest_gap_ = Duration{0}; }
  const std::optional<RobotObservation>& seen() const { return seen_; }
  /// The interval of the robot's clock ahead of this one; nullopt before the first exchange.
  std::optional<OffsetInterval> clock_offset() const { return clock_.at(bus_.now()); }
  Time now() const { return bus_.now(); }
  Time robot_now() const;

  /// Calls back with each sample once facts have shown what was executed; null: no more.
  void on_sample(std::function<void(const MotionSample&)> callback) { on_sample_ = std::move(callback); }
  /// Where facts say that the robot was at a time.
  const Version* executed_at(Time robot_time) const;

  RobotId robot() const { return robot_; }
  Duration cycle() const { return cycle_; }

 private:
  void on_feedback(const msg::Feedback& message);
  void on_world(const msg::WorldState& message);
  void take_samples();
  /// How far this process's clock is behind the robot's, as well as it is known.
  Duration robot_ahead() const;

  Bus& bus_;
  RobotId robot_;
  Duration cycle_;
  Writer<msg::Command> writer_;
  ClockOffset clock_;
  std::optional<Feedback> fact_;
  Time fact_at_{};
  std::uint64_t facts_ = 0, malformed_facts_ = 0;
  Duration longest_gap_{0};
  std::optional<RobotObservation> seen_;
  std::optional<PoseFix> fix_;  ///< not sent yet
  struct Executed {
    Version version;
    bool is_off_reference = false;
  };
  std::deque<Executed> executed_;  ///< in the order of their facts
  std::deque<RobotObservation> unjudged_;
  std::function<void(const MotionSample&)> on_sample_;
};

}  // namespace sidestep
