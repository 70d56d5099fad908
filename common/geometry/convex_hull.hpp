// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "common/geometry/vec2.hpp"

namespace sidestep {

/// The corners of the convex hull, counter-clockwise, without points on its edges: one corner if all points
/// are equal, two if they lie on a line (Andrew's monotone chain). Points are rounded to a millimetre grid,
/// so that the computation is exact.
[[nodiscard]] inline std::vector<Vec2> convex_hull(std::vector<Vec2> points_m) {
  constexpr double kPerMetre = 1000;
  for (Vec2& point : points_m) point = (kPerMetre * point).array().round().matrix();
  std::ranges::sort(points_m, {}, [](const Vec2& p) { return std::pair(p.x(), p.y()); });
  points_m.erase(std::unique(points_m.begin(), points_m.end()), points_m.end());
  std::vector<Vec2> hull;
  const auto add_chain = [&](auto first, auto last) {
    const std::size_t begin = hull.size();
    for (auto point = first; point != last; ++point) {
      while (hull.size() >= begin + 2 &&
             cross(hull.back() - hull[hull.size() - 2], *point - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(*point);
    }
    hull.pop_back();  // The last point is also the first one of the next chain.
  };
  if (points_m.size() > 1) {
    add_chain(points_m.begin(), points_m.end());
    add_chain(points_m.rbegin(), points_m.rend());
  } else {
    hull = points_m;
  }
  for (Vec2& corner : hull) corner /= kPerMetre;
  return hull;
}

}  // namespace sidestep
