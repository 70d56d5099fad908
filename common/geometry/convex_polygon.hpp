// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "common/geometry/segment.hpp"

namespace sidestep {

/// A solid convex polygon with at least three corners, counter-clockwise.
struct ConvexPolygon {
  std::vector<Vec2> corners_m;
};

/// The distance from a point to the boundary of the convex polygon with these corners, negative inside.
inline double signed_distance(const Vec2& p, std::span<const Vec2> corners) {
  double nearest2 = std::numeric_limits<double>::max();
  bool inside = true;
  for (std::size_t i = 0, last = corners.size() - 1; i < corners.size(); last = i++) {
    const Segment edge{corners[last], corners[i]};
    nearest2 = std::min(nearest2, squared_distance(p, edge));
    inside = inside && cross(edge.to_m - edge.from_m, p - edge.from_m) > 0;
  }
  return inside ? -std::sqrt(nearest2) : std::sqrt(nearest2);
}

/// The point of the polygon's boundary that is nearest to a point.
inline Vec2 nearest_edge_point(const Vec2& p, std::span<const Vec2> corners) {
  Vec2 nearest = corners.front();
  for (std::size_t i = 0, last = corners.size() - 1; i < corners.size(); last = i++) {
    const Segment edge{corners[last], corners[i]};
    const Vec2 point = edge.from_m + nearest_offset(p, edge);
    if ((point - p).squaredNorm() < (nearest - p).squaredNorm()) nearest = point;
  }
  return nearest;
}

/// The squared distance from a segment to the convex polygon with these corners, 0 inside. The polygon may be
/// degenerate (without area).
inline double squared_distance(const Segment& s, std::span<const Vec2> corners) {
  double nearest2 = std::numeric_limits<double>::max();
  bool inside = true;
  for (std::size_t i = 0, last = corners.size() - 1; i < corners.size(); last = i++) {
    const Segment edge{corners[last], corners[i]};
    nearest2 = std::min(nearest2, squared_distance(s, edge));
    inside = inside && cross(edge.to_m - edge.from_m, s.from_m - edge.from_m) > 0;
  }
  return inside ? 0 : nearest2;
}

}  // namespace sidestep
