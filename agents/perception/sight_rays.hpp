// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "common/geometry/vec2.hpp"

namespace sidestep {

/// A beam of which something is known.
struct SightRay {
  double angle_rad = 0;      ///< from the first ray, counter-clockwise
  Vec2 direction{1, 0};      ///< of length 1
  double free_m = 0;         ///< certainly free up to here, more than 0
  bool is_standing = false;  ///< ends at something that stands
};

/// How far a disc can project through a gap that is not wider than the disc.
[[nodiscard]] double sagitta_m(double radius_m, double gap_m);

/// The angle from one ray, counter-clockwise, to another; a full turn from a ray to itself.
[[nodiscard]] double angle_between_rad(const SightRay& ray, const SightRay& next);

/// The largest possible gap between the things at the ends of two rays, if both stand, and the gap is too
/// narrow for a disc of the radius. `error_m`: how much farther than free_m the things can be, in halves.
[[nodiscard]] std::optional<double> closed_gap_m(const SightRay& ray, const SightRay& next, double radius_m,
                                                 double error_m);

/// Drops rays that end at things which are too narrow to hide a disc right behind them, e.g. at a post or a
/// small robot, if the rays beside them prove more. Dropping is always conservative: nothing is known of a
/// ray that is not there.
void drop_narrow_shadows(std::vector<SightRay>& rays, double radius_m);

/// Drops the rays between things that stand, if the gap is too narrow for a disc: it can neither pass nor be
/// in front of the gap between the two remaining rays.
void drop_rays_within_gaps(std::vector<SightRay>& rays, double radius_m, double error_m);

}  // namespace sidestep
