// SPDX-License-Identifier: Apache-2.0
#include "common/motion/trajectory_bounds.hpp"

#include <algorithm>

namespace sidestep {
namespace {

// Beyond these bounds, rounding errors are not negligible against the tolerance of batch comparisons.
constexpr double kMaxCoordinate_m = 1e5;
constexpr double kMaxSpeed_mps = 1e3;
constexpr double kMaxPathLength_m = 100;
constexpr double kMaxResidualSpeed_mps = 1e-6;
// Added to the radius of the discs to cover rounding.
constexpr double kDiscRounding_m = 1e-6;

// False if a component is NaN.
bool within(const Vec2& v, double bound) { return std::abs(v.x()) <= bound && std::abs(v.y()) <= bound; }

}  // namespace

TrajectoryBounds trajectory_bounds(const Trajectory& trajectory) {
  TrajectoryBounds bounds;
  bounds.start = trajectory.start();
  bounds.at_start = trajectory.at_start();
  State state = trajectory.at_start();
  bool is_moderate = within(state.position_m, kMaxCoordinate_m);
  double path_m = 0, speed = state.velocity_mps.norm();
  int count = 0;
  for (const MotionPhase& phase : trajectory.phases()) {
    if (phase.duration == Duration::zero()) continue;
    is_moderate = is_moderate && speed <= kMaxSpeed_mps;
    const double seconds = to_seconds(phase.duration);
    if (count == 0) {
      bounds.first_s = seconds;
      bounds.first_half_mps2 = 0.5 * phase.acceleration_mps2;
    } else if (count == 1) {
      bounds.second_s = seconds;
      bounds.second_half_mps2 = 0.5 * phase.acceleration_mps2;
      bounds.second_velocity_mps = state.velocity_mps;
    }
    ++count;
    state = state_after(state, phase.acceleration_mps2, seconds);
    const double speed_after = state.velocity_mps.norm();
    // The speed is a convex function of time over a phase, so its maximum is at one of the ends.
    path_m += seconds * std::max(speed, speed_after);
    speed = speed_after;
    bounds.acceleration_mps2 = std::max(bounds.acceleration_mps2, phase.acceleration_mps2.norm());
  }
  if (count == 0) {
    bounds.at_start.velocity_mps = Vec2::Zero();
    speed = 0;
  }
  is_moderate = is_moderate && speed <= kMaxResidualSpeed_mps && within(state.position_m, kMaxCoordinate_m) &&
                bounds.acceleration_mps2 <= kMaxSpeed_mps && path_m <= kMaxPathLength_m;
  bounds.is_batchable = is_moderate && count <= 2;
  // A path of this length lies within an ellipse whose foci are the path's ends.
  bounds.disc.centre_m = 0.5 * (trajectory.at_start().position_m + state.position_m);
  bounds.disc.radius_m = 0.5 * path_m + kDiscRounding_m;
  if (!is_moderate) bounds.disc = {Vec2::Zero(), 1e300};
  return bounds;
}

}  // namespace sidestep
