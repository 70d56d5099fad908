// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>

#include "common/geometry/vec2.hpp"

namespace sidestep {

/// An axis-aligned rectangle with its inside.
struct Box {
  Vec2 min_m{0, 0}, max_m{0, 0};
};

/// The distance from a point to the box's border, negative inside.
inline double signed_distance(const Vec2& p, const Box& box) {
  const double x = std::max(box.min_m.x() - p.x(), p.x() - box.max_m.x());
  const double y = std::max(box.min_m.y() - p.y(), p.y() - box.max_m.y());
  return x > 0 && y > 0 ? std::hypot(x, y) : std::max(x, y);
}

/// Counter-clockwise.
inline std::array<Vec2, 4> corners_of(const Box& box) {
  return {box.min_m, Vec2(box.max_m.x(), box.min_m.y()), box.max_m, Vec2(box.min_m.x(), box.max_m.y())};
}

inline bool overlap(const Box& a, const Box& b) {
  return a.min_m.x() <= b.max_m.x() && b.min_m.x() <= a.max_m.x() && a.min_m.y() <= b.max_m.y() &&
         b.min_m.y() <= a.max_m.y();
}

/// The smallest box that holds both.
inline Box around(const Box& a, const Box& b) {
  return {a.min_m.cwiseMin(b.min_m), a.max_m.cwiseMax(b.max_m)};
}

/// The box with this much more on every side.
inline Box grown(const Box& box, double by_m) {
  return {box.min_m - Vec2(by_m, by_m), box.max_m + Vec2(by_m, by_m)};
}

}  // namespace sidestep
