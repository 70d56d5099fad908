// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "common/geometry/vec2.hpp"
#include "common/motion/trajectory.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// The disc of the floor in which every obstacle that vision sees is known. An unknown obstacle may be just
/// beyond its edge and approach, so the disc shrinks at the obstacles' maximum speed.
struct SeenRegion {
  Vec2 centre_m{0, 0};
  /// Radius at observed_at; infinite: all obstacles are known.
  double radius_m = std::numeric_limits<double>::infinity();
  Time observed_at{};
  double speed_mps = 0;  ///< upper bound of obstacles' speed

  [[nodiscard]] bool is_everywhere() const { return radius_m == std::numeric_limits<double>::infinity(); }
  /// The radius at a time, which may be before observed_at; negative if nothing is left.
  [[nodiscard]] double radius_at_m(Time t) const;
  /// The largest concentric disc that also lies in the other region.
  [[nodiscard]] SeenRegion limited_by(const SeenRegion& other) const;
};

/// Whether the robot is at rest before an unknown obstacle could reach it (passive safety): until the
/// trajectory ends, the disc of radius `min_separation_m`, the robot's radius plus the margin, around its
/// centre stays within the region. Conservative: never falsely true.
///
/// In each phase the position is a Bézier curve and the radius is bounded from below by a straight line. The
/// distance from the centre is convex, so the distances of the control points bound it from above.
[[nodiscard]] bool is_passively_safe_from_unseen(const Trajectory& trajectory, const SeenRegion& seen,
                                                 double min_separation_m);

}  // namespace sidestep
