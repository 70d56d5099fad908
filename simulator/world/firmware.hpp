// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "common/motion/limits.hpp"
#include "common/motion/safety_budget.hpp"
#include "common/protocol/robot_messages.hpp"
#include "simulator/world/body.hpp"
#include "simulator/world/pose_estimator.hpp"

namespace sidestep {

struct FirmwareSettings {
  BodySettings body;  ///< the firmware's model of its motors
  EstimatorSettings estimator;
  double position_gain_ps2 = 8000;  ///< of the tracking control, 1/s^2
  double velocity_gain_ps = 180;    ///< 1/s
  double heading_gain_ps = 8;
  double turning_speed_radps = 4;
  double turning_gain_ps = 25;
  double tracking_bound_m = SafetyBudget{}.tracking_bound_m;
  double deceleration_mps2 = MotionLimits{}.deceleration_mps2;  ///< D, for stops that the firmware generates
};

/// Versions and commands that a robot's firmware has received, by outcome.
struct FirmwareCounts {
  std::uint64_t activated = 0;  ///< since the last restart
  std::uint64_t refused_late = 0;
  std::uint64_t refused_base = 0;  ///< includes versions dropped because the queue was full
  std::uint64_t refused_fenced = 0;
  std::uint64_t refused_malformed = 0;
};

/// Why firmware has made a stop of its own.
enum class OwnStopReason : std::uint8_t {
  kOffReference,  ///< beyond the tracking bound
  kDrifted,       ///< beyond the drift bound for kMaxRecovery
  kDisplaced,     ///< displaced without its wheels measuring it
  kRestart,       ///< the firmware has restarted
};

constexpr const char* to_text(OwnStopReason reason) {
  switch (reason) {
    case OwnStopReason::kOffReference:
      return "it is farther from its reference than the tracking bound";
    case OwnStopReason::kDrifted:
      return "it has drifted and not returned to its reference in time";
    case OwnStopReason::kDisplaced:
      return "it was displaced without its wheels measuring it";
    case OwnStopReason::kRestart:
      return "its firmware has restarted";
  }
  return "?";
}

/// The firmware of a robot (coordinator/PROTOCOL.md, "Roles"). It executes one whole version and
/// holds a few pending ones. It switches to a version only at that version's start time, and only from its
/// base. Without commands it follows the executed version to its end and remains at rest there. Initially it
/// executes version 0, at rest at its start position.
///
/// The firmware makes a stop of its own when it may be farther from its reference than the tracking bound, or
/// than drift_bound_m() and either does not return within kMaxRecovery or was displaced without its wheels
/// measuring it. The stop is a version that brakes at D from the estimated position and velocity; the
/// firmware executes it at once. A lifted robot executes nothing (version 0 again) and accepts only a granted
/// rest version on base 0.
///
/// Firmware that has forgotten its pose brakes by its wheels, accepts no version and reports nothing, because
/// every fact contains a position. The first fix of the resting robot gives it a pose. It makes a stop of its
/// own there.
///
/// All times are by the robot's clock, which never goes back.
class Firmware {
 public:
  static constexpr int kMaxPending = 8;
  /// How long the control may take to return to the reference before the firmware makes a stop of its own.
  static constexpr Duration kMaxRecovery = std::chrono::milliseconds(25);
  /// Gap between the numbers that have reached the robot and the number of a stop of its own: versions that
  /// it has not received yet may already be granted and in transit.
  static constexpr VersionNumber kOwnNumberGap = VersionNumber{1} << 20;

  Firmware(RobotId robot, const Vec2& start_m, double heading_rad, Time now,
           const FirmwareSettings& settings);

  /// Obeys a command, or refuses and counts it. A fix that is too old, repeated or from the future is ignored
  /// without refusing the command. Precondition: the command is for this robot.
  void on_command(const Command& command, Time now);
  /// Counts a command that could not be decoded.
  void on_malformed_command(Time now);

  /// Makes the next switch of version that is due; false if none is. Every other call with a time first makes
  /// all switches due by then, so that a reported "executing f at t" remains true.
  bool switch_next(Time now);

  /// One period of the control loop, called every kPhysicsStep: the command to the motors until the next
  /// call.
  Actuation tick(Time now, const Odometry& odometry);

  /// The robot has been lifted off the floor: discards the executed version and all pending ones. Its facts
  /// name the last version as the base of nothing, number 0, so that its agent can number the next one above
  /// it. Called again, it also discards a rest version accepted since.
  void lift(Time now);
  /// The lifted robot has been put down at the rest version that it executes. Precondition:
  /// executing().number > 0.
  void put_down(double heading_rad, Time now);
  /// Restarts a robot on the floor, at the first tick later than all reported facts. It then makes a stop of
  /// its own and retains only its pose estimate, the incarnation and epoch that it obeys, and the highest
  /// number seen.
  void reboot() { is_rebooting_ = true; }
  /// As reboot(), but the pose estimate is lost too. Precondition: the robot is not lifted.
  void forget_pose(Time now);
  /// As reboot(), after a time without power: the robot takes itself to be at rest, and has forgotten its
  /// pending versions.
  void switch_on(Time now);

  /// The facts at this time, without robot_incarnation. Precondition: time never goes back between calls.
  Feedback feedback(Time now);

  const Version& executing() const { return executing_; }
  /// Whether it executes a stop of its own.
  bool is_off_reference() const { return is_off_reference_; }
  /// Why it has made the last one.
  OwnStopReason own_stop_reason() const { return own_stop_reason_; }
  bool is_lifted() const { return is_lifted_; }
  /// Whether it knows its pose. Precondition of feedback().
  bool has_pose() const { return has_pose_; }
  /// Its own estimate.
  Vec2 position_m() const { return estimator_.position_m(); }
  double heading_rad() const { return estimator_.heading_rad(); }
  Incarnation obeyed_incarnation() const { return obeyed_; }
  Epoch obeyed_epoch() const { return obeyed_epoch_; }
  const FirmwareCounts& counts() const { return counts_; }
  /// Number of stops of its own since the last restart.
  std::uint64_t own_stops() const { return own_stops_; }
  /// The start of the next pending version; Time::max() if none is pending.
  Time next_start() const { return pending_count_ > 0 ? pending_[0].trajectory.start() : Time::max(); }

 private:
  void obey(Incarnation incarnation);
  void take(const Version& version, Time now);
  void insert(const Version& version);
  void remove_pending(int index);
  bool holds(VersionNumber number) const;
  const Trajectory& planned(Time t) const;
  bool may_take(const Version& version) const;
  bool is_beyond(double bound_m, const Vec2& error_m) const;
  std::optional<OwnStopReason> must_stop(const Vec2& error_m, Time now);
  void start_own_stop(OwnStopReason reason, Time now);
  void restart(Time now);
  Actuation brake_by_wheels(Time now);
  void find_pose(const PoseFix& fix, Time now);

  RobotId robot_;
  Incarnation obeyed_ = 0;
  Epoch obeyed_epoch_ = 0;
  VersionNumber highest_seen_ = 0;  ///< of all version numbers and incarnations received
  Version executing_;
  bool has_moved_ = false;
  VersionNumber highest_executed_ = 0;
  bool is_off_reference_ = false;
  OwnStopReason own_stop_reason_ = OwnStopReason::kOffReference;
  bool is_lifted_ = false;
  bool is_rebooting_ = false;
  bool has_pose_ = true;
  Time moved_at_{};  ///< without a pose: when its wheels turned last
  Time last_fact_ = Time::min();
  Time drifted_since_ = Time::max();  ///< Time::max(): within the drift bound
  std::optional<Feedback::CommandEcho> last_command_;
  std::array<Version, kMaxPending> pending_;  ///< ascending by start, then number
  int pending_count_ = 0;
  FirmwareCounts counts_;
  std::uint64_t own_stops_ = 0;

  FirmwareSettings settings_;
  double decay_;
  Duration look_ahead_;
  double
      max_position_error_m_;  ///< at which the tracking control's approach brakes as hard as the motors can
  PoseEstimator estimator_;
  Actuation last_actuation_;
  Actuation modelled_;  ///< current accelerations, by the motor model
  double target_heading_rad_;
};

}  // namespace sidestep
