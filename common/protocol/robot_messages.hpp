// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/motion/version.hpp"

namespace sidestep {

/// Pose of a robot as measured by vision.
struct PoseFix {
  Time captured_at{};
  Vec2 position_m{0, 0};
  double heading_rad = 0;
};

/// Agent to robot; see Command in idl/robot.idl.
struct Command {
  RobotId robot = 0;
  Incarnation incarnation = 0;  ///< the agent's incarnation
  Epoch epoch = 0;              ///< highest epoch that the agent knows; 0: none
  Time sent_at{};               ///< by the agent's clock
  std::optional<Version> version{};
  std::optional<PoseFix> fix{};
  double desired_heading_rad = 0;
};

/// A robot's own estimate of how well it is localised.
struct LocalisationUncertainty {
  double position_error_rms_m = 0;   ///< root mean square error of its position estimate
  double odometry_scale_stddev = 0;  ///< standard deviation of its odometry's relative error
};

/// The facts that a robot reports: at `valid_at` it executed `executing`. See Feedback in idl/robot.idl. All
/// times are by the robot's clock, except CommandEcho::sent_at.
struct RobotReport {
  /// The last command of the agent that the robot obeys.
  struct CommandEcho {
    Time sent_at{};  ///< by the agent's clock
    Time received_at{};
  };

  RobotId robot = 0;
  Incarnation robot_incarnation = 0;  ///< incarnation of the process that speaks for the robot
  Incarnation obeyed_incarnation = 0;
  Epoch obeyed_epoch = 0;
  Time valid_at{};
  Version executing;
  bool is_off_reference = false;
  bool is_lifted = false;
  std::optional<CommandEcho> command{};
  State estimate;  ///< the robot's own estimate
  double heading_rad = 0;
  double tracking_error_m = 0;
  LocalisationUncertainty uncertainty{};
  bool has_moved = false;       ///< the robot has executed a granted version
  std::uint64_t activated = 0;  ///< number of switches to a version since the firmware's last restart
  Duration lead{0};             ///< time before a version's start by which the robot must have received it

  /// Whether the robot is off the floor and executes nothing.
  bool is_absent() const { return is_lifted && executing.number == 0; }
};

}  // namespace sidestep
