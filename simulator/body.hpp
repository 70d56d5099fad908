// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/vec2.hpp"
#include "common/motion/trajectory.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// The step of the physics, and the period of the firmware's control loop.
inline constexpr Duration kPhysicsStep{1'000'000};
inline constexpr double kPhysicsStepSeconds = to_seconds(kPhysicsStep);

/// What the wheels and motors can do.
struct BodySettings {
  double lag_s = 0.012;  ///< time constant between a wanted acceleration and the real one
  double acceleration_mps2 = 6;
  double speed_mps = 2.5;
  double angular_acceleration_radps2 = 40;
  double angular_speed_radps = 8;
};

/// What firmware asks of the motors, in the world's frame.
struct Actuation {
  Vec2 acceleration_mps2{0, 0};
  double angular_acceleration_radps2 = 0;
};

/// An omnidirectional robot's body. Its acceleration follows the wanted one with a first-order lag and within
/// limits.
class Body {
 public:
  Body(const Vec2& position_m, double heading_rad, const BodySettings& settings);

  /// Moves on by kPhysicsStep, integrated exactly below the speed limit. A wish beyond the limits is cut off;
  /// one that is not a number counts as none.
  void step(const Actuation& wanted);

  /// Something outside moved it: a contact.
  void push(const Vec2& shift_m, const Vec2& velocity_change_mps);

  const Vec2& position_m() const { return state_.position_m; }
  const Vec2& velocity_mps() const { return state_.velocity_mps; }
  const Vec2& acceleration_mps2() const { return acceleration_mps2_; }
  /// Counts whole turns.
  double heading_rad() const { return heading_rad_; }
  double angular_radps() const { return angular_radps_; }

 private:
  State state_;
  Vec2 acceleration_mps2_{0, 0};
  double heading_rad_;
  double angular_radps_ = 0;
  double angular_acceleration_radps2_ = 0;
  BodySettings settings_;
  double decay_;
};

}  // namespace sidestep
