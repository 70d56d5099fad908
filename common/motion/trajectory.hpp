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

/// A stretch of constant acceleration.
struct MotionPhase {
  Duration duration{0};
  Vec2 acceleration_mps2{0, 0};
};

/// A state and the acceleration in force.
struct Motion {
  State state;
  Vec2 acceleration_mps2{0, 0};
};

/// The state after a time in a phase that began in `from`.
inline State state_after(const State& from, const Vec2& acceleration_mps2, double elapsed_s) {
  return {from.position_m + elapsed_s * (from.velocity_mps + (0.5 * elapsed_s) * acceleration_mps2),
          from.velocity_mps + elapsed_s * acceleration_mps2};
}

/// A robot's reference motion over absolute time: from its start on a few phases of constant acceleration,
/// then at rest for ever. It says nothing about the time before its start.
class Trajectory {
 public:
  static constexpr int kMaxPhases = 4;

  Trajectory() = default;
  Trajectory(Time start, const State& at_start) : start_(start), at_start_(at_start) {}

  /// At rest for ever.
  static Trajectory resting(Time start, const Vec2& position_m) {
    return {start, {position_m, Vec2::Zero()}};
  }

  /// Appends a phase; the caller keeps to kMaxPhases.
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

  /// The state at a time; at rest at the end point from end() on; the start state before the start.
  State state_at(Time t) const { return motion_at(t).state; }
  /// The acceleration in force at a time (of the phase that begins, at a boundary); zero from end() on, and
  /// before the start.
  Vec2 acceleration_at(Time t) const { return motion_at(t).acceleration_mps2; }
  Motion motion_at(Time t) const;
  Vec2 rest_position_m() const;
  /// What is left of the velocity when the last phase ends: nearly zero for a valid trajectory.
  double residual_speed_mps() const;

 private:
  Time start_{};
  State at_start_;
  MotionPhase phases_[kMaxPhases];
  int count_ = 0;
};

/// Deceleration against the velocity until rest (Bruce, ch. 5): the tail of every trajectory. Appends nothing
/// when the trajectory already ends at rest.
void append_stop(Trajectory& trajectory, double deceleration_mps2);

/// Bounds how far a trajectory gets from its start position, over all time.
double reach_m(const Trajectory& trajectory);

}  // namespace sidestep
