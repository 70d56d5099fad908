// SPDX-License-Identifier: Apache-2.0
#include "common/motion/trajectory_bounds.hpp"

#include <algorithm>

namespace sidestep {
namespace {

// Beyond these, rounding would no longer be far below what comparisons in batches allow for.
constexpr double kFarthest_m = 1e5;
constexpr double kFastest_mps = 1e3;
constexpr double kLongestWay_m = 100;
constexpr double kMostResidual_mps = 1e-6;
// Discs are larger by this than computed.
constexpr double kDiscRounding_m = 1e-6;

// Written so that a NaN fails it.
bool within(const Vec2& v, double bound) { return std::abs(v.x()) <= bound && std::abs(v.y()) <= bound; }

}  // namespace

TrajectoryBounds trajectory_bounds(const Trajectory& trajectory) {
  TrajectoryBounds outline;
  outline.start = trajectory.start();
  outline.at_start = trajectory.at_start();
  State state = trajectory.at_start();
  bool is_moderate = within(state.position_m, kFarthest_m);
  double travel = 0, speed = state.velocity_mps.norm();
  int count = 0;
  for (const MotionPhase& phase : trajectory.phases()) {
    if (phase.duration == Duration::zero()) continue;
    is_moderate = is_moderate && speed <= kFastest_mps;
    const double seconds = to_seconds(phase.duration);
    if (count == 0) {
      outline.first_s = seconds;
      outline.first_half_mps2 = 0.5 * phase.acceleration_mps2;
    } else if (count == 1) {
      outline.second_s = seconds;
      outline.second_half_mps2 = 0.5 * phase.acceleration_mps2;
      outline.second_velocity_mps = state.velocity_mps;
    }
    ++count;
    outline.seconds += seconds;
    state = state_after(state, phase.acceleration_mps2, seconds);
    const double speed_after = state.velocity_mps.norm();
    // The speed is convex over a phase, so its larger end bounds it.
    travel += seconds * std::max(speed, speed_after);
    speed = speed_after;
    outline.acceleration_mps2 = std::max(outline.acceleration_mps2, phase.acceleration_mps2.norm());
  }
  if (count == 0) {
    outline.at_start.velocity_mps = Vec2::Zero();
    speed = 0;
  }
  is_moderate = is_moderate && speed <= kMostResidual_mps && within(state.position_m, kFarthest_m) &&
                outline.acceleration_mps2 <= kFastest_mps && travel <= kLongestWay_m;
  outline.is_plain = is_moderate && count <= 2;
  // Every point of a way of this length lies in an ellipse about both ends.
  outline.disc.centre_m = 0.5 * (trajectory.at_start().position_m + state.position_m);
  outline.disc.radius_m = 0.5 * travel + kDiscRounding_m;
  if (!is_moderate) outline.disc = {Vec2::Zero(), 1e300};
  return outline;
}

}  // namespace sidestep
