// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/motion/limits.hpp"
#include "common/motion/trajectory.hpp"

namespace sidestep {

/// A fast motion of a moving robot to rest at a goal, without regard to obstacles: the robot turns with one
/// constant acceleration until it moves towards the goal, or stops, and then drives straight. Of several
/// accelerations, the one with the earliest arrival is used. A robot at rest, or one that already moves
/// towards its goal and can stop there, takes the shortest time possible. Precondition: the speed is within
/// the limit.
[[nodiscard]] Trajectory fastest_stop(Time start, const State& from, const Vec2& goal_m,
                                      const MotionLimits& limits);

/// Upper bound of the duration of fastest_stop(), quickly computed: the robot stops, and then drives
/// straight.
[[nodiscard]] double longest_stop_s(const State& from, const Vec2& goal_m, const MotionLimits& limits);

}  // namespace sidestep
