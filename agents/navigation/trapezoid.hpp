// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "common/geometry/vec2.hpp"
#include "common/motion/limits.hpp"

namespace sidestep {

/// Time-optimal motion along one axis from a velocity to rest at a distance: up to four stretches of constant
/// acceleration (brake what points the wrong way, accelerate, cruise, brake).
class Trapezoid {
 public:
  /// Reaches `distance_m` (either sign) from velocity `velocity_mps`; all limits > 0. A velocity beyond the
  /// speed limit is braked down to it first.
  Trapezoid(double distance_m, double velocity_mps, const MotionLimits& limits);

  double duration_s() const;
  /// That of a Trapezoid with these arguments, for less.
  static double duration_s(double distance_m, double velocity_mps, const MotionLimits& limits);
  /// For how long the first acceleration is held; 0 when there is nothing to do.
  double first_stretch_s() const { return count_ > 0 ? stretches_[0].seconds : 0; }
  double velocity_after(double seconds) const;

 private:
  /// Calls for each stretch with its seconds, above zero, and its acceleration.
  template <typename Add>
  static void for_each_stretch(double distance, double velocity, const MotionLimits& limits, Add add);

  struct Stretch {
    double seconds, acceleration;
  };
  std::array<Stretch, 5> stretches_{};
  int count_ = 0;
  double velocity_;
};

/// Two-dimensional trapezoidal motion control (Bruce, app. B): the axis along the way and the one across it
/// share the robot's acceleration, and the share is balanced by binary search so that both finish at the same
/// time.
class Trapezoid2d {
 public:
  /// The way from `velocity_mps` to rest at the offset `to_go_m`.
  Trapezoid2d(const Vec2& to_go_m, const Vec2& velocity_mps, const MotionLimits& limits);

  Vec2 velocity_after(double seconds) const;
  /// The motion along the way.
  const Trapezoid& along() const { return along_; }

 private:
  Vec2 direction_;
  Trapezoid along_, across_;
};

}  // namespace sidestep
