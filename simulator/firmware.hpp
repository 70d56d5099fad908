// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "common/motion/limits.hpp"
#include "common/motion/safety_budget.hpp"
#include "common/motion/version.hpp"
#include "idl/robot.h"
#include "simulator/body.hpp"
#include "simulator/pose_estimator.hpp"

namespace sidestep {

struct FirmwareSettings {
  BodySettings body;  ///< what the firmware knows of its motors
  EstimatorSettings estimator;
  double position_gain_ps2 = 8000;  ///< of the tracking control, per square second
  double velocity_gain_ps = 180;    ///< per second
  double heading_gain_ps = 8;
  double turning_speed_radps = 4;
  double turning_gain_ps = 25;
  double tracking_bound_m = SafetyBudget{}.tracking_bound_m;
  double deceleration_mps2 = MotionLimits{}.deceleration_mps2;  ///< D, of the stop that it makes itself
};

/// What became of the versions and commands that came.
struct FirmwareCounts {
  std::uint64_t taken = 0;
  std::uint64_t refused_late = 0;
  std::uint64_t refused_base = 0;  ///< also those there was no room for
  std::uint64_t refused_fenced = 0;
  std::uint64_t refused_malformed = 0;
  std::uint64_t broke_off = 0;  ///< stops of its own, off its reference
};

/// A robot's firmware (safety-protocol.md, "Who does what"). It executes one whole version and holds a few
/// that are still to begin; it switches to one only at its start time, and only from its base. Without any
/// command it follows what it executes to its end and stays at rest there. At creation it executes version 0:
/// at rest for ever on its mark.
///
/// When it may be farther from its reference than the tracking bound, and does not get back within kCure, or
/// is twice as far, or was moved past its wheels, it breaks off: it makes a version of its own, which brakes
/// at D from where and how fast it believes to be, and executes that. Lifted off the floor it executes
/// nothing (version 0 again), and takes a granted stand on version 0 only.
///
/// All times are by the robot's clock, which never goes back.
class Firmware {
 public:
  static constexpr int kMaxPending = 8;
  /// So long its control may take to bring it back to its reference.
  static constexpr Duration kCure = std::chrono::milliseconds(25);
  /// Between the numbers it has seen and the number of a stop of its own: versions that it has not seen may
  /// be granted and under way.
  static constexpr VersionNumber kOwnNumberGap = VersionNumber{1} << 20;

  Firmware(RobotId robot, const Vec2& mark_m, double heading_rad, Time now, const FirmwareSettings& settings);

  /// Obeys, or refuses and counts. A command that is malformed in any part changes nothing. A heading that is
  /// not a number makes a command malformed; a fix that is too old, repeated or from the future is only
  /// ignored.
  void on_command(const msg::Command& command, Time now);

  /// Makes the next switch of version that is due; false when none is. Every other call with a time makes all
  /// switches due by then first, so that "executing f at t" stays true for ever.
  bool switch_next(Time now);

  /// One period of the control loop, called every kPhysicsStep: what the motors shall do until the next.
  Actuation tick(Time now, const Odometry& odometry);

  /// Somebody takes the robot off the floor; what it executed and held is void. Once more: so is the stand
  /// that it has taken since.
  void lift(Time now);
  /// Somebody puts the lifted robot down where the stand that it executes lies, which has a number above 0.
  void put_down(double heading_rad, Time now);
  /// Starts again, on the floor, with the next tick that is later than all facts: breaks off, and then knows
  /// where it believes to be, what it has obeyed and the highest number that it has seen, and nothing else.
  void reboot() { is_rebooting_ = true; }

  /// The facts at a time not before the last call's. The head is the caller's to fill.
  msg::Feedback feedback(Time now);

  const Version& executing() const { return executing_; }
  /// Whether it executes a stop of its own.
  bool is_off_reference() const { return is_off_reference_; }
  bool is_lifted() const { return is_lifted_; }
  Incarnation obeyed_incarnation() const { return obeyed_; }
  Epoch obeyed_epoch() const { return obeyed_epoch_; }
  const FirmwareCounts& counts() const { return counts_; }
  const PoseEstimator& estimate() const { return estimator_; }
  /// When the next held version starts; Time::max() when none is held.
  Time next_start() const { return pending_count_ > 0 ? pending_[0].trajectory.start() : Time::max(); }

 private:
  void obey(Incarnation incarnation);
  void take(const Version& version, Time now);
  void insert(const Version& version);
  void remove_pending(int index);
  bool knows(VersionNumber number) const;
  const Trajectory& planned(Time t) const;
  bool may_take(const Version& version) const;
  bool is_beyond_bound(const Vec2& error_m) const;
  bool must_break_off(const Vec2& error_m, Time now);
  void break_off(Time now);
  void start_again(Time now);

  RobotId robot_;
  Incarnation obeyed_ = 0;
  Epoch obeyed_epoch_ = 0;
  VersionNumber highest_ = 0;  ///< of all numbers and incarnations that came
  Version executing_;
  VersionNumber newest_ = 0;  ///< highest number executed so far
  bool is_off_reference_ = false;
  bool is_lifted_ = false;
  bool is_rebooting_ = false;
  Time last_fact_ = Time::min();
  Time beyond_since_ = Time::max();  ///< the tracking bound
  std::int64_t heard_stamp_ns_ = 0;
  Time heard_at_{};
  std::array<Version, kMaxPending> pending_;  ///< ascending by start, then number
  int pending_count_ = 0;
  FirmwareCounts counts_;

  FirmwareSettings settings_;
  double decay_;
  Duration look_ahead_;
  double most_lead_m_;  ///< distance from which the tracking control's approach brakes as hard as motors can
  PoseEstimator estimator_;
  Actuation last_desired_;
  Actuation believed_;  ///< accelerations by the motor model
  double heading_goal_rad_;
};

}  // namespace sidestep
