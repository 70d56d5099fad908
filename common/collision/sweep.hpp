// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/box.hpp"
#include "common/geometry/circle.hpp"
#include "common/geometry/segment.hpp"

namespace sidestep {

/// A disc that moves straight from one position to another.
struct Sweep {
  /// Throws std::invalid_argument if a number is not finite or the radius is negative.
  Sweep(const Vec2& from, const Vec2& to, double radius);

  Segment segment() const { return {from_m, to_m}; }
  /// The bounding box of the swept area.
  Box bounds() const { return inflated({from_m.cwiseMin(to_m), from_m.cwiseMax(to_m)}, radius_m); }
  bool touches(const Circle& circle) const {
    const double reach_m = radius_m + circle.radius_m;
    return squared_distance(circle.centre_m, segment()) <= reach_m * reach_m;
  }

  Vec2 from_m, to_m;
  double radius_m;
};

}  // namespace sidestep
