// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

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
  double friction_mps2 = 6;  ///< with which the floor pulls a body along that its wheels slide on
};

/// What firmware asks of the motors, in the world's frame.
struct Actuation {
  Vec2 acceleration_mps2{0, 0};
  double angular_acceleration_radps2 = 0;
};

/// An omnidirectional robot's body. Its acceleration follows the wanted one with a first-order lag and within
/// limits. The wheels roll, so that they measure how the body moves, unless something makes them slide.
class Body {
 public:
  Body(const Vec2& position_m, double heading_rad, const BodySettings& settings);

  /// Moves on by kPhysicsStep, integrated exactly below the speed limit. A wish beyond the limits is cut off;
  /// one that is not a number counts as none.
  void step(const Actuation& wanted);

  /// Something outside moved it: a contact.
  void push(const Vec2& shift_m, const Vec2& velocity_change_mps);

  /// Something outside changed its velocity past its wheels, which go on as they did: it slides until the
  /// floor has pulled it along.
  void shove(const Vec2& velocity_change_mps);
  /// The share of every acceleration, 0 to 1, that reaches the floor.
  void set_grip(double share);
  /// A wheel stands still: no rolling along a direction, an angle from the heading; nothing: all turn.
  void set_blocked(std::optional<double> direction_rad);
  /// Off the floor a body does not move.
  void lift();
  /// Back on the floor, at rest.
  void put_down(const Vec2& position_m, double heading_rad);
  bool is_on_floor() const { return is_on_floor_; }
  /// Where it would be if its wheels had never slid.
  Vec2 rolled_to_m() const { return state_.position_m - slid_m_; }

  const Vec2& position_m() const { return state_.position_m; }
  const Vec2& velocity_mps() const { return state_.velocity_mps; }
  const Vec2& acceleration_mps2() const { return acceleration_mps2_; }
  /// Counts whole turns.
  double heading_rad() const { return heading_rad_; }
  double angular_radps() const { return angular_radps_; }

 private:
  void roll(const Actuation& wanted);
  void slide(const Actuation& wanted);
  bool is_sliding() const;

  State state_;
  Vec2 acceleration_mps2_{0, 0};
  double heading_rad_;
  double angular_radps_ = 0;
  double angular_acceleration_radps2_ = 0;
  BodySettings settings_;
  double decay_;

  bool is_plain_ = true;  ///< on the floor, and rolling
  bool is_on_floor_ = true;
  double grip_ = 1;
  std::optional<double> blocked_rad_;
  Vec2 slip_mps_{0, 0};  ///< of the body against what its wheels roll
  Vec2 slid_m_{0, 0};
};

}  // namespace sidestep
