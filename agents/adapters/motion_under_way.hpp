// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/geometry/vec2.hpp"
#include "common/robot/robot_side.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// Where the commands under way lead a base, at a time after the first point of its path.
struct PathPoint {
  Duration after{0};
  Vec2 position_m{0, 0};
};

/// The motion along a path that is straight and even between its points, in parts in which the velocity
/// changes evenly and which end at `last_velocity_mps`. Its error_m bounds the distance from the path at
/// every time. Precondition: times ascend from 0. A path of one point takes no time and has no parts.
[[nodiscard]] robot::MotionUnderWay<float> fit_motion_under_way(std::span<const PathPoint> path,
                                                                const Vec2& last_velocity_mps);

}  // namespace sidestep
