// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/motion/limits.hpp"
#include "common/motion/safety_budget.hpp"
#include "common/protocol/robot_messages.hpp"
#include "common/robot/robot_side.hpp"
#include "common/tracking/pose_estimator.hpp"
#include "simulator/world/body.hpp"

namespace sidestep {

struct FirmwareSettings {
  BodySettings body;  ///< the firmware's model of its motors
  EstimatorSettings estimator;
  double tracking_bound_m = SafetyBudget{}.tracking_bound_m;
  /// D, used for stops that the firmware generates.
  double deceleration_mps2 = MotionLimits{}.deceleration_mps2;
};

/// Firmware memory that survives the simulated robot's restarts. The Firmware object also survives restarts.
class SimulatedFlash final : public robot::StableMemory {
 public:
  [[nodiscard]] bool store(const robot::DurableState&) override { return true; }
};

/// The firmware of a simulated robot: the robot's side of the protocol (common/robot/robot_side.hpp), with
/// control and estimation. Initially it executes version 0, at rest at its start position.
///
/// Firmware that has forgotten its pose brakes by its wheels, accepts no version and reports nothing, because
/// every fact contains a position. The first fix after the robot has come to rest gives it a pose; it then
/// makes an own stop there.
///
/// All times are by the robot's clock, which goes back only in set_clock_back().
class Firmware {
 public:
  Firmware(RobotId robot, const Vec2& start_m, double heading_rad, Time now,
           const FirmwareSettings& settings);

  /// Obeys a command, or refuses and counts it. A fix that is too old, repeated or from the future is ignored
  /// without refusing the command. Precondition: the command is for this robot.
  void on_command(const Command& command, Time now);
  /// Counts a command that could not be decoded.
  void on_malformed_command(Time now);

  /// Switches to the next version if it is due; false if none is due. Every other function that takes a time
  /// first makes all switches that are due by that time, so that a reported "executing f at t" remains true.
  bool switch_next(Time now);

  /// Runs one period of the control loop; called every kPhysicsStep. Returns the command to the motors until
  /// the next call.
  Actuation tick(Time now, const Odometry& odometry);

  /// The robot was lifted off the floor: discards the executed version and all pending ones. Facts then
  /// report version 0 and name the last version as its base, so that the agent can number the next version
  /// above it. A second call also discards a rest version that was accepted since the first.
  void lift(Time now);
  /// The robot has been put down; it executes a rest version at that place. Precondition: executing().number
  /// > 0.
  void put_down(double heading_rad, Time now);
  /// Restarts a robot on the floor, at the first tick later than all reported facts. It then makes an own
  /// stop and retains only its pose estimate, the incarnation and epoch that it obeys, and the highest number
  /// seen.
  void reboot() { side_.reboot(); }
  /// Like reboot(), but the pose estimate is also lost. Precondition: the robot is not lifted.
  void forget_pose(Time now);
  /// Like reboot(), but after a time without power: the robot assumes that it is at rest, and has lost its
  /// pending versions.
  void switch_on(Time now);

  /// The robot's clock reads `now` although it already read `before`. The robot must start a new incarnation,
  /// and makes an own stop by the new time.
  void set_clock_back(Time before, Time now);

  /// The facts at this time, without robot_incarnation. Precondition: time only goes back through
  /// set_clock_back().
  RobotReport robot_report(Time now);

  const Version& executing() const { return executing_; }
  /// Whether the robot executes an own stop.
  bool is_off_reference() const { return side_.is_off_reference(); }
  robot::OwnStopReason own_stop_reason() const { return side_.own_stop_reason(); }
  bool is_lifted() const { return side_.is_lifted(); }
  bool has_pose() const { return side_.has_pose(); }
  /// Whether robot_report() may be called.
  bool may_report() const { return side_.may_report() && estimator_.is_finite(); }
  /// The robot's own estimate of its position.
  Vec2 position_m() const { return estimator_.position_m(); }
  double heading_rad() const { return estimator_.heading_rad(); }
  Incarnation obeyed_incarnation() const { return side_.obeyed_incarnation(); }
  Epoch obeyed_epoch() const { return side_.obeyed_epoch(); }
  const robot::Counts& counts() const { return side_.counts(); }
  /// Number of own stops since the last restart.
  std::uint64_t own_stops() const { return side_.own_stops(); }
  /// The start of the next pending version; Time::max() if none is pending.
  Time next_start() const { return side_.has_pending() ? time_from_ns(side_.next_start_ns()) : Time::max(); }

 private:
  void update_executing();
  robot::Estimate<double> estimate(Time now) const;
  Actuation track(Time now) const;
  double turn() const;
  Actuation brake_by_wheels(Time now);
  void find_pose(const PoseFix& fix, Time now);

  RobotId robot_;
  SimulatedFlash flash_;
  robot::RobotSide<double> side_;
  Version executing_;  ///< copy of side_.executing()
  Time moved_at_{};    ///< time at which the wheels last turned; used without a pose
  FirmwareSettings settings_;
  double decay_;
  Duration look_ahead_;
  double max_position_error_m_;  ///< position error beyond which the tracking control would brake harder than
                                 ///< the motors can
  PoseEstimator estimator_;
  Actuation last_actuation_;
  Actuation modelled_;  ///< current accelerations according to the motor model
  double target_heading_rad_;
};

}  // namespace sidestep
