// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>
#include <cstdint>
#include <span>

#include "common/geometry/vec2.hpp"
#include "common/time/time.hpp"

namespace sidestep {

struct State {
  Vec2 position_m{0, 0};
  Vec2 velocity_mps{0, 0};
};

/// A part of a trajectory with constant acceleration.
struct MotionPhase {
  Duration duration{0};
  Vec2 acceleration_mps2{0, 0};
};

/// A state and the current acceleration.
struct Motion {
  State state;
  Vec2 acceleration_mps2{0, 0};
};

/// The state after an elapsed time at constant acceleration.
inline State state_after(const State& from, const Vec2& acceleration_mps2, double elapsed_s) {
  return {from.position_m + elapsed_s * (from.velocity_mps + (0.5 * elapsed_s) * acceleration_mps2),
          from.velocity_mps + elapsed_s * acceleration_mps2};
}

/// A robot's reference motion over absolute time: a few phases of constant acceleration, then rest. It is
/// undefined before its start.
class Trajectory {
 public:
  static constexpr int kMaxPhases = 4;

  Trajectory() = default;
  Trajectory(Time start, const State& at_start) : start_(start), at_start_(at_start) {}

  /// Creates a trajectory that is at rest from `start` on.
  static Trajectory resting(Time start, const Vec2& position_m) {
    return {start, {position_m, Vec2::Zero()}};
  }

  /// Appends a phase. Precondition: fewer than kMaxPhases phases.
  void append(Duration duration, const Vec2& acceleration_mps2) {
    assert(count_ < kMaxPhases);
    phases_[count_++] = {duration, acceleration_mps2};
  }

  Time start() const { return start_; }
  Time end() const {
    Time t = start_;
    for (const MotionPhase& phase : phases()) t += phase.duration;
    return t;
  }
  const State& at_start() const { return at_start_; }
  std::span<const MotionPhase> phases() const { return {phases_, static_cast<std::size_t>(count_)}; }

  /// The state at a time. Before the start this is the start state; from end() on the robot is at rest.
  State state_at(Time t) const { return motion_at(t).state; }
  /// The state and the acceleration at a time. At a phase boundary the acceleration is that of the later
  /// phase. It is zero before the start and from end() on.
  Motion motion_at(Time t) const;
  Vec2 rest_position_m() const;
  /// The speed at the end of the last phase. In a valid trajectory it is zero up to rounding.
  double residual_speed_mps() const;

 private:
  Time start_{};
  State at_start_;
  MotionPhase phases_[kMaxPhases];
  int count_ = 0;
};

/// Appends the stop that ends every trajectory: deceleration against the velocity until rest (Bruce,
/// CMU-CS-06-181, ch. 5). No effect if the trajectory already ends at rest.
void append_stop(Trajectory& trajectory, double deceleration_mps2);

/// An upper bound of the distance from the start position, over all time.
double reach_m(const Trajectory& trajectory);

}  // namespace sidestep
