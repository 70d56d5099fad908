// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/geometry/vec2.hpp"
#include "common/motion/trajectory.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// The time step of the physics, and the period of the firmware's control loop.
inline constexpr Duration kPhysicsStep{1'000'000};
inline constexpr double kPhysicsStepSeconds = to_seconds(kPhysicsStep);

/// The capabilities of wheels and motors.
struct BodySettings {
  double lag_s = 0.012;  ///< time constant from commanded to actual acceleration
  double acceleration_mps2 = 6;
  double speed_mps = 2.5;
  double angular_acceleration_radps2 = 40;
  double angular_speed_radps = 8;
  double friction_mps2 = 6;  ///< acceleration that the floor exerts on a body whose wheels slip
};

/// Accelerations commanded to the motors, in the world frame.
struct Actuation {
  Vec2 acceleration_mps2{0, 0};
  double angular_acceleration_radps2 = 0;
};

/// The body of an omnidirectional robot. Its acceleration follows the command with a first-order lag and
/// within limits. The wheels roll, so they measure the body's motion, unless a disturbance makes them slip.
class Body {
 public:
  static constexpr double kRolling_mps2 = 0.5;  ///< deceleration of a body without power

  Body(const Vec2& position_m, double heading_rad, const BodySettings& settings);

  /// Advances by kPhysicsStep; the integration is exact below the speed limit. A command beyond the limits is
  /// clamped, and one that is not finite counts as zero.
  void step(const Actuation& command);

  /// Displaces the body and changes its velocity, including that of the wheels. Models the effect of a
  /// contact.
  void displace(const Vec2& shift_m, const Vec2& velocity_change_mps);

  /// Changes the body's velocity but not that of its wheels: the body slips until friction has brought it
  /// back to the wheels' velocity.
  void push(const Vec2& velocity_change_mps);
  /// Sets the grip: the fraction, 0 to 1, of the wheels' acceleration and of friction that reaches the body.
  void set_grip(double share);
  /// Blocks a wheel, so that the wheels do not roll in a direction, given as an angle from the heading.
  /// nullopt: no wheel is blocked.
  void set_blocked_wheel(std::optional<double> direction_rad);
  /// Switches the power. A body without power rolls on until friction stops it, and obeys no command.
  void set_powered(bool is_powered);
  /// Moves the body at a velocity just above the floor, so that its wheels do not roll. nullopt: puts it
  /// down, at rest.
  void carry(const std::optional<Vec2>& velocity_mps);
  /// Takes the body off the floor. It does not move until it is put down.
  void lift();
  /// Puts the body on the floor, at rest.
  void put_down(const Vec2& position_m, double heading_rad);
  bool is_on_floor() const { return is_on_floor_; }
  /// The position without slip, as ideal wheel odometry would measure it.
  Vec2 rolled_position_m() const { return state_.position_m - total_slip_m_; }

  const Vec2& position_m() const { return state_.position_m; }
  const Vec2& velocity_mps() const { return state_.velocity_mps; }
  const Vec2& acceleration_mps2() const { return acceleration_mps2_; }
  /// The heading without wrapping: it counts full turns.
  double heading_rad() const { return heading_rad_; }
  double angular_radps() const { return angular_radps_; }

 private:
  void roll(const Actuation& command);
  void slide(const Actuation& command);
  void coast();
  bool is_sliding() const;
  void update_rolling();

  State state_;
  Vec2 acceleration_mps2_{0, 0};
  double heading_rad_;
  double angular_radps_ = 0;
  double angular_acceleration_radps2_ = 0;
  BodySettings settings_;
  double decay_;  ///< decay of the lag over one step

  bool is_rolling_ = true;  ///< on the floor, powered, and free of slip
  bool is_powered_ = true;
  std::optional<Vec2> carried_mps_;
  bool is_on_floor_ = true;
  double grip_ = 1;
  std::optional<double> blocked_rad_;
  Vec2 slip_mps_{0, 0};      ///< velocity of the body relative to its rolling wheels
  Vec2 total_slip_m_{0, 0};  ///< total slip since creation
};

}  // namespace sidestep
