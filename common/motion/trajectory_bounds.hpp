// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/circle.hpp"
#include "common/motion/trajectory.hpp"

namespace sidestep {

/// A trajectory as many are compared with at a time: in at most two phases, and what bounds it.
struct TrajectoryBounds {
  Time start{};
  bool is_plain = false;  ///< has at most two phases and moderate numbers; others are compared one by one
  State at_start;
  double first_s = 0, second_s = 0;  ///< how long the phases last; the first is empty only if both are
  Vec2 first_half_mps2{0, 0}, second_half_mps2{0, 0};  ///< half their accelerations
  Vec2 second_velocity_mps{0, 0};                      ///< as the second phase begins
  double seconds = 0;                                  ///< until it rests
  double acceleration_mps2 = 0;                        ///< the largest
  Circle disc;                                         ///< never left, from the start on for ever
};

TrajectoryBounds trajectory_bounds(const Trajectory& trajectory);

/// The outline's disc.
inline Circle disc_of(const Trajectory& trajectory) { return trajectory_bounds(trajectory).disc; }

}  // namespace sidestep
