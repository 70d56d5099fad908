// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "common/geometry/vec2.hpp"

namespace sidestep {

/// A line segment; its ends may coincide.
struct Segment {
  Vec2 from_m{0, 0}, to_m{0, 0};
};

/// The point on a segment nearest to a given point, relative to the segment's start.
inline Vec2 nearest_offset(const Vec2& p, const Segment& s) {
  const Vec2 direction = s.to_m - s.from_m, off = p - s.from_m;
  const double length2 = direction.squaredNorm();
  const double along = length2 > 0 ? std::clamp(off.dot(direction) / length2, 0.0, 1.0) : 0.0;
  return along * direction;
}

/// The squared distance from a point to a segment.
inline double squared_distance(const Vec2& p, const Segment& s) {
  return (p - s.from_m - nearest_offset(p, s)).squaredNorm();
}

/// Whether two segments cross, each with its ends on different sides of the other. An end on the other
/// segment's line is assigned to a side by rounding, so callers also have to check the distances of the ends.
inline bool intersect(const Segment& a, const Segment& b) {
  const Vec2 along_a = a.to_m - a.from_m, along_b = b.to_m - b.from_m;
  const double from_b = cross(along_a, b.from_m - a.from_m), to_b = cross(along_a, b.to_m - a.from_m);
  const double from_a = cross(along_b, a.from_m - b.from_m), to_a = cross(along_b, a.to_m - b.from_m);
  if ((from_b < 0) == (to_b < 0) || (from_a < 0) == (to_a < 0)) return false;
  // Collinear segments may seem to cross due to rounding: require overlapping bounding boxes.
  return (a.from_m.cwiseMin(a.to_m).array() <= b.from_m.cwiseMax(b.to_m).array()).all() &&
         (b.from_m.cwiseMin(b.to_m).array() <= a.from_m.cwiseMax(a.to_m).array()).all();
}

/// The squared distance between two segments.
inline double squared_distance(const Segment& a, const Segment& b) {
  if (intersect(a, b)) return 0;
  return std::min({squared_distance(a.from_m, b), squared_distance(a.to_m, b), squared_distance(b.from_m, a),
                   squared_distance(b.to_m, a)});
}

}  // namespace sidestep
