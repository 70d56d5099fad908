// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/geometry/vec2.hpp"
#include "common/motion/trajectory.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// Something that moves without asking, an opponent or a person, as it was last seen: from then on it may be
/// anywhere that its speed takes it.
struct MovingObstacle {
  Vec2 position_m{0, 0};
  double radius_m = 0;  ///< its own, and what its position is uncertain by
  Time seen_at{};
  double speed_mps = 0;  ///< that it never exceeds

  /// How far from position_m its edge may be at a time; before it was seen it may have been elsewhere, too.
  double reach_m(Time t) const;
};

/// Whether the robot comes to rest before the obstacle could reach it: at every time of the trajectory before
/// its end the robot's centre is farther than `min_separation_m` (its radius and the margin) from wherever the
/// obstacle's edge may be. Afterwards the robot is at rest, and that is all that it can promise. The answer
/// yes is never wrong; no may be, within a micrometre.
///
/// Squared distance less squared reach is a quartic on each phase. In Bernstein form its least coefficient
/// bounds it from below, and halving the phase brings the bound up to the quartic itself (Lane, Riesenfeld
/// 1981).
bool rests_before(const Trajectory& trajectory, const MovingObstacle& obstacle, double min_separation_m);
bool rests_before_all(const Trajectory& trajectory, std::span<const MovingObstacle> obstacles, double min_separation_m);

}  // namespace sidestep
