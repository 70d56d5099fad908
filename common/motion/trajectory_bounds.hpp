// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/circle.hpp"
#include "common/motion/trajectory.hpp"

namespace sidestep {

/// Bounds of a trajectory, and its phases in the form that batch comparisons use.
struct TrajectoryBounds {
  Time start{};
  bool is_batchable =
      false;  ///< has at most two phases and moderate numbers; otherwise it is compared individually
  State at_start;
  double first_s = 0, second_s = 0;  ///< durations of the phases; if first_s is 0, second_s is 0
  Vec2 first_half_mps2{0, 0}, second_half_mps2{0, 0};  ///< half the accelerations of the phases
  Vec2 second_velocity_mps{0, 0};                      ///< velocity at the start of the second phase
  double acceleration_mps2 = 0;                        ///< maximum magnitude of the acceleration
  Circle disc;                                         ///< contains the trajectory from its start on
};

TrajectoryBounds trajectory_bounds(const Trajectory& trajectory);

/// A disc that contains the trajectory from its start on.
inline Circle disc_of(const Trajectory& trajectory) { return trajectory_bounds(trajectory).disc; }

}  // namespace sidestep
