// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>

namespace sidestep {

/// A point of an integer grid. With coordinates up to kMaxGridCoordinate, orientations are exact. Points are
/// ordered by x, and by y if x is equal. This is the order along the x axis after an infinitesimal shear,
/// which leaves no segment vertical (de Berg et al. 2008, section 6.3).
struct GridPoint {
  std::int32_t x = 0, y = 0;
  auto operator<=>(const GridPoint&) const = default;
};
inline constexpr std::int32_t kMaxGridCoordinate = 1 << 29;

/// A segment between grid points, left < right.
struct GridSegment {
  GridPoint left, right;
  auto operator<=>(const GridSegment&) const = default;
};

/// Twice the area of a triangle, positive if its corners are counter-clockwise.
inline std::int64_t orientation(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  return std::int64_t{b.x - a.x} * (c.y - a.y) - std::int64_t{b.y - a.y} * (c.x - a.x);
}

/// Positive if a point lies above a segment's line, negative if below. The left side of a vertical segment
/// counts as above.
inline std::int64_t height_above(const GridSegment& segment, const GridPoint& point) {
  return orientation(segment.left, segment.right, point);
}

/// The y coordinate at which a vertical line through a point intersects a segment above or below the point.
inline double y_at(const GridSegment& segment, const GridPoint& point) {
  const double width = segment.right.x - segment.left.x;
  if (width == 0) return point.y;
  return segment.left.y + (point.x - segment.left.x) / width * (segment.right.y - segment.left.y);
}

}  // namespace sidestep
