// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/navigation/dynamic_window/arc_motion.hpp"
#include "agents/navigation/dynamic_window/velocity_grid.hpp"

namespace sidestep {

/// Rim speeds of the two wheels, positive forwards.
struct WheelSpeeds {
  double left_mps = 0, right_mps = 0;
};

/// A robot with two wheels on a common axis. The origin of its frame is midway between them, with the x axis
/// ahead. The defaults describe the Robox robots (Philippsen, EPFL thesis 3146).
struct DifferentialDrive {
  double wheel_base_m = 0.521;
  double wheel_speed_mps = 0.572;          ///< maximum for each wheel
  double wheel_acceleration_mps2 = 0.572;  ///< maximum for each wheel, also when braking
  double speed_mps = 0.5;                  ///< maximum for the robot
  double turn_rate_radps = 2;              ///< maximum for the robot

  ArcMotion motion(const WheelSpeeds& wheels) const {
    return {(wheels.left_mps + wheels.right_mps) / 2, (wheels.right_mps - wheels.left_mps) / wheel_base_m};
  }
  /// Rows of the velocity grid are speeds of the left wheel; columns are speeds of the right wheel.
  WheelSpeeds wheels(int row, int column) const {
    return {grid_speed(row, wheel_speed_mps), grid_speed(column, wheel_speed_mps)};
  }
  bool is_allowed(const ArcMotion& motion) const {
    constexpr double kRounding = 1e-9;
    return std::abs(motion.speed_mps) <= speed_mps + kRounding &&
           std::abs(motion.turn_rate_radps) <= turn_rate_radps + kRounding;
  }
  /// Time until both wheels are at rest. They slow down in proportion, which keeps the robot on its arc.
  double time_to_brake_s(const WheelSpeeds& wheels) const {
    return std::max(std::abs(wheels.left_mps), std::abs(wheels.right_mps)) / wheel_acceleration_mps2;
  }
  /// The wheel speeds after braking on the same arc for some time.
  WheelSpeeds braked(const WheelSpeeds& wheels, double seconds) const;
};

/// Throws std::invalid_argument if a value is not positive and finite.
void check(const DifferentialDrive& drive);

}  // namespace sidestep
