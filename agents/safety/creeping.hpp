// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "common/motion/trajectory.hpp"

namespace sidestep {

/// A robot that is no faster than this counts as being at rest.
inline constexpr double kCreep_mps = 0.03;

/// Whether a trajectory is never faster than `creep_mps`, and ends where `distance_m`, a lower bound of the
/// distance from whoever may touch the robot, is larger than at its start. A robot at a place that somebody
/// may already have reached could otherwise never leave.
template <typename Distance>
[[nodiscard]] bool creeps_away(const Trajectory& trajectory, double creep_mps, Distance distance_m) {
  State state = trajectory.at_start();
  double fastest_mps = state.velocity_mps.norm();
  for (const MotionPhase& phase : trajectory.phases()) {
    state = state_after(state, phase.acceleration_mps2, to_seconds(phase.duration));
    fastest_mps = std::max(fastest_mps, state.velocity_mps.norm());
  }
  return fastest_mps <= creep_mps &&
         distance_m(state.position_m) > distance_m(trajectory.at_start().position_m);
}

}  // namespace sidestep
