// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "agents/adapters/base_rest.hpp"
#include "agents/adapters/commanded_motion.hpp"
#include "agents/adapters/driver.hpp"
#include "agents/adapters/measured_motion.hpp"
#include "agents/adapters/odometry_timestamp_check.hpp"
#include "common/config/scenario.hpp"
#include "common/protocol/robot_messages.hpp"
#include "common/robot/robot_side.hpp"
#include "common/tracking/pose_estimator.hpp"

namespace sidestep {

/// Properties of a driven robot and its base.
struct DriveSettings {
  /// Delay from a command until the base moves accordingly.
  Duration latency = std::chrono::milliseconds(100);
  double tracking_bound_m = SafetyBudget{}.tracking_bound_m;
  MotionLimits limits;
  double fix_noise_m = 0.0005;  ///< standard deviation of vision's position error, on each axis
  /// Standard deviation of the relative error of a base's odometry.
  double scale_error = 0.005;
  /// Maximum speed at which the robot turns. It is predicted, so the base must be able to turn as fast.
  double turn_radps = 3;
};

DriveSettings drive_settings(const Scenario& scenario, Duration latency);

/// A robot that a driver moves. It consists of the robot's side of the protocol in single precision, the
/// estimate of its pose, and the control of its velocity. The base obeys after a latency, so the robot
/// predicts its position after the latency and steers towards its reference's position at that time. It
/// refuses versions that arrive too late for this. It starts without a pose, and stays at rest until vision's
/// pose fixes agree on where it is. All times are by the process's clock, which never goes back.
class DrivenRobot {
 public:
  /// Period of the control loop.
  static constexpr Duration kPeriod = std::chrono::milliseconds(10);

  DrivenRobot(RobotId robot, const DriveSettings& settings, const robot::DurableState& remembered, Time now);

  void on_command(const Command& command, Time now, robot::StableMemory& memory);
  void on_malformed_command(Time now);
  /// Processes a base's measurement of its own motion, which is more accurate than the commands. A report
  /// with a wrong timestamp is refused and counted, because a velocity from another time would displace the
  /// estimate.
  void on_odometry(const OdometryReport& report, Time now);
  /// Number of odometry reports with timestamps that cannot be trusted.
  std::uint64_t misdated_odometry() const { return misdated_; }

  /// Runs one period of the control loop and returns the velocity to send now.
  BodyVelocity tick(Time now, robot::StableMemory& memory);

  /// Whether the robot can report: it knows its pose.
  bool may_report() const { return side_.may_report() && estimator_.is_finite(); }
  /// The robot's report, without robot_incarnation. Precondition: may_report().
  RobotReport robot_report(Time now);

  /// Whether the robot's versions have ended and the base has received the commands of their ends, so that it
  /// stays at rest unless further versions arrive.
  bool is_at_rest(Time now) const;
  /// Whether fixes show no motion of the base.
  bool is_base_at_rest(Time now) const { return base_rest_.is_at_rest(now); }
  /// From now on commands no motion, not even a correction.
  void stand_still() { stands_still_ = true; }

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
  /// Makes the pose unknown until new fixes agree on it.
  void forget_pose(Time now);
  /// The mean velocity in the world frame, predicted from the commands alone.
  Odometry commanded(Time from, Time to, double heading_rad) const;
  /// The pose predicted from the commands already sent. Precondition: `at` is not before the estimator's
  /// time.
  Pose predicted(Time at) const;
  robot::Estimate<float> estimate(Time now) const;
  /// The motion caused by commands already sent, until a command sent now takes effect.
  robot::MotionUnderWay<float> under_way(Time now, const Pose& pose) const;
  BodyVelocity track(Time now) const;
  void add_first_fix(const PoseFix& fix, Time now);
  void use_fix(const PoseFix& fix);

  RobotId robot_;
  DriveSettings settings_;
  robot::RobotSide<float> side_;
  CommandedMotion commands_;
  MeasuredMotion measured_;
  OdometryTimestampCheck timestamp_check_;
  std::uint64_t misdated_ = 0;
  PoseEstimator estimator_;
  BaseRest base_rest_;
  bool stands_still_ = false;
  /// Oldest fix that is waiting for the odometry of its capture time, which arrives later.
  std::optional<PoseFix> waiting_fix_;
  double target_heading_rad_ = 0;
  Time moved_at_;  ///< while the pose is unknown: latest time at which the robot may have moved
  std::array<PoseFix, 3> first_fixes_{};  ///< while the pose is unknown: the latest fixes that agree
  std::size_t first_fix_count_ = 0;
};

}  // namespace sidestep
