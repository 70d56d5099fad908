// SPDX-License-Identifier: Apache-2.0
#include "common/motion/trajectory.hpp"

#include <algorithm>

namespace sidestep {

Motion Trajectory::motion_at(Time t) const {
  State state = at_start_;
  if (t < start_) return {state};
  Duration left = t - start_;
  for (const MotionPhase& phase : phases()) {
    const Vec2& acceleration = phase.acceleration_mps2;
    if (left < phase.duration) return {state_after(state, acceleration, to_seconds(left)), acceleration};
    state = state_after(state, acceleration, to_seconds(phase.duration));
    left -= phase.duration;
  }
  return {{state.position_m, Vec2::Zero()}};
}

namespace {

State state_after_phases(const Trajectory& trajectory) {
  State state = trajectory.at_start();
  for (const MotionPhase& phase : trajectory.phases()) {
    state = state_after(state, phase.acceleration_mps2, to_seconds(phase.duration));
  }
  return state;
}

}  // namespace

Vec2 Trajectory::rest_position_m() const { return state_after_phases(*this).position_m; }

double Trajectory::residual_speed_mps() const { return state_after_phases(*this).velocity_mps.norm(); }

void append_stop(Trajectory& trajectory, double deceleration_mps2) {
  const Vec2 velocity = state_after_phases(trajectory).velocity_mps;
  const double speed = velocity.norm();
  if (speed < 1e-12) return;
  // The duration is rounded up to whole nanoseconds and the deceleration reduced to match, so that the
  // trajectory ends exactly at rest.
  const Duration duration{static_cast<std::int64_t>(std::ceil(speed / deceleration_mps2 * 1e9))};
  trajectory.append(duration, -velocity / to_seconds(duration));
}

double reach_m(const Trajectory& trajectory) {
  double reach = 0;
  State state = trajectory.at_start();
  for (const MotionPhase& phase : trajectory.phases()) {
    const double seconds = to_seconds(phase.duration);
    // The speed is a convex function of time over a phase, so its maximum is at one of the ends.
    const State next = state_after(state, phase.acceleration_mps2, seconds);
    // std::max returns its first argument if that is NaN, so NaN is passed on.
    reach += seconds * std::max(next.velocity_mps.norm(), state.velocity_mps.norm());
    state = next;
  }
  return reach;
}

}  // namespace sidestep
