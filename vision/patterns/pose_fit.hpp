// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/geometry/vec2.hpp"

namespace sidestep {

struct Pose {
  Vec2 position_m{0, 0};
  double heading_rad = 0;

  /// Transforms a point from the robot's frame to the world frame.
  Vec2 to_world(const Vec2& body_m) const { return position_m + rotated(body_m, heading_rad); }
};

/// A point in the robot's frame, and its observed position in the world.
struct PointCorrespondence {
  Vec2 body_m{0, 0};
  Vec2 observed_m{0, 0};
};

/// The least-squares pose of a robot (Bruce, CMU-CS-06-181, appendix A.2.2): maps the centroid of the body
/// points onto that of the observed points, and rotates by the angle given by the sums of dot and cross
/// products. Precondition: at least two points that do not coincide.
[[nodiscard]] Pose fit_pose(std::span<const PointCorrespondence> points);

/// Root mean square distance between the observed points and the body points at this pose.
[[nodiscard]] double rms_residual_m(const Pose& pose, std::span<const PointCorrespondence> points);

}  // namespace sidestep
