// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/navigation/dynamic_window/arc_motion.hpp"
#include "common/geometry/convex_hull.hpp"
#include "common/geometry/convex_polygon.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// The convex hull of a few random points, at most `radius_m` from the origin on each axis.
inline ConvexPolygon random_hull(Rng& rng, double radius_m) {
  for (;;) {
    std::vector<Vec2> points;
    const std::size_t count = 3 + rng.below(8);
    while (points.size() < count) {
      const double x = rng.uniform(-radius_m, radius_m), y = rng.uniform(-radius_m, radius_m);
      points.emplace_back(x, y);
    }
    std::vector<Vec2> corners = convex_hull(points);
    if (corners.size() >= 3) return {std::move(corners)};
  }
}

/// A robot with a pointed front, 0.55 m long.
inline ConvexPolygon pointed_hull() {
  return {{{-0.25, -0.2}, {0.2, -0.2}, {0.3, 0}, {0.2, 0.2}, {-0.25, 0.2}}};
}

/// A random motion. Some are straight or nearly straight, turn on the spot, or do not move.
inline ArcMotion random_motion(Rng& rng) {
  const double speed = rng.uniform(-1, 1), turn = rng.uniform(-3, 3);
  switch (rng.below(10)) {
    case 0:
      return {speed, 0};
    case 1:
      return {speed, turn * 1e-12};
    case 2:
      return {speed, turn * 1e-5};
    case 3:
      return {0, turn};
    case 4:
      return {0, 0};
    default:
      return {speed, turn};
  }
}

inline Vec2 random_point(Rng& rng, double half_side_m) {
  const double x = rng.uniform(-half_side_m, half_side_m), y = rng.uniform(-half_side_m, half_side_m);
  return {x, y};
}

}  // namespace sidestep
