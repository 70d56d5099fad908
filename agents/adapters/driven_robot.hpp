// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "agents/adapters/commanded_motion.hpp"
#include "agents/adapters/driver.hpp"
#include "agents/adapters/measured_motion.hpp"
#include "agents/adapters/odometry_dates.hpp"
#include "common/config/scenario.hpp"
#include "common/protocol/robot_messages.hpp"
#include "common/robot/robot_side.hpp"
#include "common/tracking/pose_estimator.hpp"

namespace sidestep {

/// How a driven robot is controlled. Defaults are for bases that follow their commands as the league's
/// simulators do.
struct DriveSettings {
  Duration latency = std::chrono::milliseconds(100);  ///< from a command until the base moves accordingly
  double tracking_bound_m = SafetyBudget{}.tracking_bound_m;
  MotionLimits limits;
  double fix_noise_m = 0.0005;       ///< standard deviation of vision, per axis
  double velocity_noise_mps = 0.05;  ///< with which a base follows its commands
  /// With which it measures its motion, where it does.
  double odometry_noise_mps = 0.01;
  double scale_error = 0.005;  ///< standard deviation of its relative error
  double position_gain_ps = 4;
  double max_correction_mps = 0.3;  ///< added to the reference's speed to return to it
  double heading_gain_ps = 4;
  double turning_speed_radps = 3;
};

DriveSettings drive_settings(const Scenario& scenario, Duration latency);

/// One robot that a driver moves: the robot's side of the protocol in single precision, with the estimate of
/// its pose and the control of its velocity. The base obeys after a latency, so the robot predicts where it
/// will be then and steers towards where its reference is then; it refuses versions that come later.
///
/// It begins without a pose and stands until fixes agree on where it is. All times are by the process's
/// clock, which never goes back.
class DrivenRobot {
 public:
  /// Of the control loop.
  static constexpr Duration kPeriod = std::chrono::milliseconds(10);

  DrivenRobot(RobotId robot, const DriveSettings& settings, const robot::DurableState& remembered, Time now);

  void on_command(const Command& command, Time now, robot::StableMemory& memory);
  void on_malformed_command(Time now);
  /// A base's measurement of its own motion is better than what it was commanded. It is refused and counted
  /// if its date is wrong: the robot would be where its velocity of another time takes it.
  void on_odometry(const OdometryReport& report, Time now);
  /// Reports of odometry whose dates cannot be believed.
  std::uint64_t misdated_odometry() const { return misdated_; }

  /// One period of the control loop: the velocity to send now.
  BodyVelocity tick(Time now, robot::StableMemory& memory);

  /// Whether it has something to say: it knows its pose.
  bool may_report() const { return side_.may_report() && estimator_.is_finite(); }
  /// The facts, without robot_incarnation. Precondition: may_report().
  Feedback feedback(Time now);

  /// Whether the base stands, and goes on standing without further versions.
  bool is_at_rest(Time now) const;

  const robot::RobotSide<float>& side() const { return side_; }
  RobotId id() const { return robot_; }
  /// The start of the next pending version; Time::max() if none is pending.
  Time next_start() const { return side_.has_pending() ? time_from_ns(side_.next_start_ns()) : Time::max(); }

 private:
  struct Pose {
    Vec2 position_m{0, 0};
    double heading_rad = 0;
  };
  void advance(Time now);
  /// Nobody knows where it is until first fixes agree on it.
  void forget_pose(Time now);
  /// The velocity by the commands alone, in the world.
  Odometry commanded(Time from, Time to, double heading_rad) const;
  /// The pose at a time at or after the estimator's, by the commands under way.
  Pose predicted(Time at) const;
  robot::Estimate<float> estimate(Time now) const;
  /// Where the commands under way lead the robot until a command that is sent now is obeyed.
  robot::MotionUnderWay<float> under_way(Time now, const Pose& pose) const;
  BodyVelocity track(Time now) const;
  void add_first_fix(const PoseFix& fix, Time now);
  void use_fix(const PoseFix& fix);

  RobotId robot_;
  DriveSettings settings_;
  robot::RobotSide<float> side_;
  CommandedMotion commands_;
  MeasuredMotion measured_;
  OdometryDates odometry_dates_;
  std::uint64_t misdated_ = 0;
  PoseEstimator estimator_;
  std::optional<PoseFix> waiting_fix_;  ///< for the odometry of its time, which comes later; the oldest one
  double target_heading_rad_ = 0;
  Time moved_at_;                         ///< without a pose: when it may have moved last
  std::array<PoseFix, 3> first_fixes_{};  ///< without a pose: the latest ones that agree
  std::size_t first_fix_count_ = 0;
};

}  // namespace sidestep
