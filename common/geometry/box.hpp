// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>

#include "common/geometry/vec2.hpp"

namespace sidestep {

/// A solid axis-aligned rectangle.
struct Box {
  Vec2 min_m{0, 0}, max_m{0, 0};
};

/// The distance from a point to the box's boundary, negative inside.
inline double signed_distance(const Vec2& p, const Box& box) {
  const double x = std::max(box.min_m.x() - p.x(), p.x() - box.max_m.x());
  const double y = std::max(box.min_m.y() - p.y(), p.y() - box.max_m.y());
  return x > 0 && y > 0 ? std::hypot(x, y) : std::max(x, y);
}

/// The corners, counter-clockwise.
inline std::array<Vec2, 4> corners_of(const Box& box) {
  return {box.min_m, Vec2(box.max_m.x(), box.min_m.y()), box.max_m, Vec2(box.min_m.x(), box.max_m.y())};
}

inline bool overlap(const Box& a, const Box& b) {
  return a.min_m.x() <= b.max_m.x() && b.min_m.x() <= a.max_m.x() && a.min_m.y() <= b.max_m.y() &&
         b.min_m.y() <= a.max_m.y();
}

/// The smallest box that contains both boxes.
inline Box united(const Box& a, const Box& b) {
  return {a.min_m.cwiseMin(b.min_m), a.max_m.cwiseMax(b.max_m)};
}

/// The box, extended by `inflation_m` on every side; a negative inflation shrinks it.
inline Box inflated(const Box& box, double inflation_m) {
  return {box.min_m - Vec2(inflation_m, inflation_m), box.max_m + Vec2(inflation_m, inflation_m)};
}

}  // namespace sidestep
