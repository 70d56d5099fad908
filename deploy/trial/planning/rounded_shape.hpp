// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "common/collision/shapes.hpp"

namespace sidestep {

/// A point, segment or convex polygon (counter-clockwise) inflated by a radius: a common representation of
/// all obstacles. Used by the reference checks; shares no arithmetic with the collision structures that
/// planners query.
struct RoundedShape {
  std::vector<Vec2> corners_m;
  double radius_m = 0;
};
[[nodiscard]] RoundedShape rounded(const Shape& shape);

struct ClosestPoints {
  Vec2 a_m, b_m;
  double distance_m = 0;
};
/// The closest points of two convex polygons, segments or points given by their corners. Where they
/// intersect, the distance is 0 and both points are the same common point.
[[nodiscard]] ClosestPoints closest_points(std::span<const Vec2> a_m, std::span<const Vec2> b_m);

}  // namespace sidestep
