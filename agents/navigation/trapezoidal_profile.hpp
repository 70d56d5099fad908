// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "common/geometry/vec2.hpp"
#include "common/motion/limits.hpp"

namespace sidestep {

/// Time-optimal motion along one axis, from a velocity to rest at a distance. It consists of up to four
/// phases of constant acceleration: brake a velocity of the wrong sign, accelerate, cruise, brake.
class TrapezoidalProfile {
 public:
  /// `distance_m` may have either sign; all limits > 0. A velocity above the speed limit is first braked down
  /// to it.
  TrapezoidalProfile(double distance_m, double velocity_mps, const MotionLimits& limits);

  double duration_s() const;
  /// Duration of a TrapezoidalProfile with these arguments, without constructing it.
  static double duration_s(double distance_m, double velocity_mps, const MotionLimits& limits);
  /// Duration of the first phase; 0 if the profile is empty.
  double first_phase_s() const { return count_ > 0 ? phases_[0].seconds : 0; }
  double velocity_after(double seconds) const;

 private:
  /// Calls `add(seconds, acceleration)` for each phase with a duration above zero.
  template <typename Add>
  static void for_each_phase(double distance, double velocity, const MotionLimits& limits, Add add);

  struct Phase {
    double seconds, acceleration;
  };
  std::array<Phase, 5> phases_{};
  int count_ = 0;
  double velocity_;
};

/// Two-dimensional trapezoidal motion control (Bruce 2006, appendix B). The axes along and across the
/// displacement share the robot's limits; binary search balances the shares so that both finish at the same
/// time.
class TrapezoidalProfile2d {
 public:
  /// The motion from `velocity_mps` to rest at `displacement_m`.
  TrapezoidalProfile2d(const Vec2& displacement_m, const Vec2& velocity_mps, const MotionLimits& limits);

  Vec2 velocity_after(double seconds) const;
  /// The motion along the displacement.
  const TrapezoidalProfile& along() const { return along_; }

 private:
  Vec2 direction_;
  TrapezoidalProfile along_, across_;
};

}  // namespace sidestep
