// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/box.hpp"
#include "common/geometry/segment.hpp"

namespace sidestep {

/// A disc that moves straight from one point to another, prepared for many comparisons.
struct Sweep {
  /// Throws std::invalid_argument where a number is not finite or the radius is negative.
  Sweep(const Vec2& from, const Vec2& to, double radius) : from_m(from), way_m(to - from), radius_m(radius) {
    const double length2 = way_m.squaredNorm();
    // Whatever is not finite makes the length infinite or not a number.
    if (!(length2 <= kLongest_m * kLongest_m && radius >= 0 && radius <= kLongest_m)) refuse();
    per_length2 = length2 > 0 ? 1 / length2 : 0;
  }

  Vec2 to_m() const { return from_m + way_m; }
  Segment segment() const { return {from_m, to_m()}; }
  /// What the disc sweeps lies in here.
  Box bounds() const {
    const Vec2 to = to_m(), reach(radius_m, radius_m);
    return {from_m.cwiseMin(to) - reach, from_m.cwiseMax(to) + reach};
  }
  /// Whether a disc is touched.
  bool touches(double x_m, double y_m, double disc_radius_m) const {
    const double dx = x_m - from_m.x(), dy = y_m - from_m.y();
    double along = (dx * way_m.x() + dy * way_m.y()) * per_length2;
    along = along > 0 ? along : 0;
    along = along < 1 ? along : 1;
    const double ex = dx - along * way_m.x(), ey = dy - along * way_m.y(), reach = radius_m + disc_radius_m;
    return ex * ex + ey * ey <= reach * reach;
  }

  Vec2 from_m, way_m;
  double radius_m;
  double per_length2;  ///< 0 where the disc stands still

 private:
  static constexpr double kLongest_m = 1e100;
  [[noreturn]] static void refuse();
};

}  // namespace sidestep
