// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/geometry/vec2.hpp"

namespace sidestep {

struct Pose {
  Vec2 position_m{0, 0};
  double heading_rad = 0;

  Vec2 to_world(const Vec2& of_robot_m) const { return position_m + rotated(of_robot_m, heading_rad); }
};

/// A point of the robot, and where it is seen.
struct SeenPoint {
  Vec2 of_robot_m{0, 0};
  Vec2 seen_m{0, 0};
};

/// The pose that puts the points where they are seen, by least squares (Bruce, appendix A.3): centroid onto
/// centroid, turned by the angle of the sums of dot and cross products. Precondition: at least two points,
/// not all in one place.
Pose fitted_pose(std::span<const SeenPoint> points);

/// The root of the mean squared distance between where the points are and where the pose puts them.
double residual_m(const Pose& pose, std::span<const SeenPoint> points);

}  // namespace sidestep
