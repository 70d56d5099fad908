// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "common/geometry/segment.hpp"

namespace sidestep {

/// A beam that is known to be free for some distance.
struct SightRay {
  double angle_rad = 0;  ///< counter-clockwise from the first ray
  Vec2 direction{1, 0};  ///< unit vector
  double free_m = 0;     ///< certainly free up to this distance, which is positive
  /// The known stationary point nearest to the ray's end, relative to the scanner; nullopt: none is near.
  std::optional<Vec2> post_m{};
  double post_error_m = 0;  ///< maximum error of that point in the scan's frame
};

/// A gap between two known stationary points; no person can pass it.
struct ClosedGap {
  Segment posts;       ///< ends, relative to the scanner
  double bulge_m = 0;  ///< maximum distance that a person can ever protrude through the gap
  double reach_m = 0;  ///< maximum distance from stationary objects at which such a person can touch a robot
  double unseen_bulge_m = 0;  ///< maximum distance that a person could protrude between the rays at capture
};

/// How far a disc can protrude through a gap that is not wider than the disc.
[[nodiscard]] double sagitta_m(double radius_m, double gap_m);

/// The counter-clockwise angle from one ray to another ray; a full turn from a ray to itself.
[[nodiscard]] double angle_between_rad(const SightRay& ray, const SightRay& next);

/// How far from a stationary point a person of this radius can reach by protruding across a line, if the
/// person crosses the line at most `from_m` from the point. Precondition: from_m <= radius_m.
[[nodiscard]] double projection_m(double radius_m, double from_m);

/// The closed gap between the ends of two rays; nullopt if it is not closed. It is closed if no disc of this
/// radius can ever have its centre on the line between the ends, and none was in front of that line when the
/// rays were free. For this, every point of the line must be so near to one of two posts that the disc would
/// touch the post, and the ends of the rays must be too close together for a disc to fit in between.
[[nodiscard]] std::optional<ClosedGap> closed_gap(const SightRay& ray, const SightRay& next, double radius_m);

/// Drops rays that end at an object too narrow to hide a disc directly behind it, such as a post or a small
/// robot, if the neighbouring rays prove more. Dropping is always conservative, because nothing is assumed
/// about missing rays.
void drop_narrow_shadows(std::vector<SightRay>& rays, double radius_m);

/// Drops the rays within closed gaps: a disc can neither pass nor be in front of the gap between the
/// remaining rays.
void drop_rays_within_gaps(std::vector<SightRay>& rays, double radius_m);

}  // namespace sidestep
