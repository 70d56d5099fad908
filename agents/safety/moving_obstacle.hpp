// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/geometry/vec2.hpp"
#include "common/motion/trajectory.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// An opponent or a person as last observed. It does not take part in the protocol. After the observation it
/// may be anywhere that it can reach at its maximum speed.
struct MovingObstacle {
  Vec2 position_m{0, 0};
  double radius_m = 0;  ///< includes the uncertainty of the position
  Time observed_at{};
  double speed_mps = 0;  ///< upper bound of the speed
  /// Estimated velocity, possibly NaN. Passive safety does not depend on it.
  Vec2 velocity_mps{0, 0};

  /// Maximum distance of the obstacle's edge from position_m at a time, which may be before the observation.
  [[nodiscard]] double reach_m(Time t) const;
};

/// Whether the robot is at rest before the obstacle could reach it (passive safety): until the trajectory
/// ends, the robot's centre stays farther than `min_separation_m`, its radius plus the margin, from every
/// possible position of the obstacle's edge. Conservative: never falsely true; false negatives only within 1
/// µm.
///
/// The squared distance minus the squared reach is a quartic in each phase. The smallest coefficient of its
/// Bernstein form is a lower bound, which converges to the quartic as the phase is halved (Lane, Riesenfeld
/// 1981).
[[nodiscard]] bool is_passively_safe(const Trajectory& trajectory, const MovingObstacle& obstacle,
                                     double min_separation_m);
/// Whether the robot is at rest before any of the obstacles could reach it, or creeps away from those that
/// could; see creeping.hpp. With a `creep_mps` of 0 it may not creep.
[[nodiscard]] bool is_passively_safe_from_all(const Trajectory& trajectory,
                                              std::span<const MovingObstacle> obstacles,
                                              double min_separation_m, double creep_mps = 0);

}  // namespace sidestep
