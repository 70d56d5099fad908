// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "common/geometry/segment.hpp"

namespace sidestep {

/// A beam of which something is known.
struct SightRay {
  double angle_rad = 0;  ///< from the first ray, counter-clockwise
  Vec2 direction{1, 0};  ///< of length 1
  double free_m = 0;     ///< certainly free up to here, more than 0
  /// A point that is known to stand, relative to the scanner, the nearest one to the ray's end; nullopt: none
  /// is near.
  std::optional<Vec2> post_m{};
  double post_error_m = 0;  ///< how far the point can be from there in the scan's frame
};

/// A gap between two points that are known to stand, which no person can pass.
struct ClosedGap {
  Segment posts;              ///< relative to the scanner
  double bulge_m = 0;         ///< how far from it a person can ever project through it
  double reach_m = 0;         ///< how far from what stands
  double unseen_bulge_m = 0;  ///< how far a person could project between the rays at capture
};

/// How far a disc can project through a gap that is not wider than the disc.
[[nodiscard]] double sagitta_m(double radius_m, double gap_m);

/// The angle from one ray, counter-clockwise, to another; a full turn from a ray to itself.
[[nodiscard]] double angle_between_rad(const SightRay& ray, const SightRay& next);

/// How far from a point that stands a person of the radius can project, if one who projects does so across a
/// line, at a place that is at most `from_m` away from the point. Precondition: from_m <= radius_m.
[[nodiscard]] double projection_m(double radius_m, double from_m);

/// The gap at the ends of two rays, if the centre of no disc of the radius is ever on the line between them,
/// nor was before it when the rays were free: every point of the line is so near to one of two posts that the
/// disc would touch it, and the ends of the rays are too near to each other for a disc between them.
[[nodiscard]] std::optional<ClosedGap> closed_gap(const SightRay& ray, const SightRay& next, double radius_m);

/// Drops rays that end at things which are too narrow to hide a disc right behind them, e.g. at a post or a
/// small robot, if the rays beside them prove more. Dropping is always conservative: nothing is known of a
/// ray that is not there.
void drop_narrow_shadows(std::vector<SightRay>& rays, double radius_m);

/// Drops the rays within closed gaps: a disc can neither pass nor be in front of the gap between the two
/// remaining rays.
void drop_rays_within_gaps(std::vector<SightRay>& rays, double radius_m);

}  // namespace sidestep
