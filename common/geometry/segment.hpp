// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "common/geometry/vec2.hpp"

namespace sidestep {

/// A straight line between two points, which may be the same.
struct Segment {
  Vec2 from_m{0, 0}, to_m{0, 0};
};

/// The square of the distance from a point to the nearest one of a segment.
inline double squared_distance(const Vec2& p, const Segment& s) {
  const Vec2 way = s.to_m - s.from_m, off = p - s.from_m;
  const double length2 = way.squaredNorm();
  const double along = length2 > 0 ? std::clamp(off.dot(way) / length2, 0.0, 1.0) : 0.0;
  return (off - along * way).squaredNorm();
}

/// Whether segments cross, each with its ends on different sides of the other. The sides of ends that are on
/// the other's line are left to rounding: whoever asks has to look at the ends' distances too.
inline bool cross_each_other(const Segment& a, const Segment& b) {
  const Vec2 along_a = a.to_m - a.from_m, along_b = b.to_m - b.from_m;
  const double from_b = cross(along_a, b.from_m - a.from_m), to_b = cross(along_a, b.to_m - a.from_m);
  const double from_a = cross(along_b, a.from_m - b.from_m), to_a = cross(along_b, a.to_m - b.from_m);
  if ((from_b < 0) == (to_b < 0) || (from_a < 0) == (to_a < 0)) return false;
  // Segments one behind the other on one line are on different sides by rounding only.
  return (a.from_m.cwiseMin(a.to_m).array() <= b.from_m.cwiseMax(b.to_m).array()).all() &&
         (b.from_m.cwiseMin(b.to_m).array() <= a.from_m.cwiseMax(a.to_m).array()).all();
}

/// The square of the smallest distance between points of two segments.
inline double squared_distance(const Segment& a, const Segment& b) {
  if (cross_each_other(a, b)) return 0;
  return std::min({squared_distance(a.from_m, b), squared_distance(a.to_m, b), squared_distance(b.from_m, a),
                   squared_distance(b.to_m, a)});
}

}  // namespace sidestep
