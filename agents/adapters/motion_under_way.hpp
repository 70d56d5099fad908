// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/geometry/vec2.hpp"
#include "common/robot/robot_side.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// A point on a base's path under commands that were already sent, with its time after the first point.
struct PathPoint {
  Duration after{0};
  Vec2 position_m{0, 0};
};

/// Fits a motion to a path. The base on the path moves at constant velocity between the points. The motion
/// consists of parts in which the velocity changes linearly, and ends at `last_velocity_mps`. Its error_m
/// bounds the distance from the path at all times. Precondition: times ascend from 0. The motion for a path
/// with one point has no parts.
[[nodiscard]] robot::MotionUnderWay<float> fit_motion_under_way(std::span<const PathPoint> path,
                                                                const Vec2& last_velocity_mps);

}  // namespace sidestep
