// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/vec2.hpp"

namespace sidestep {

struct Circle {
  Vec2 centre_m{0, 0};
  double radius_m = 0;
};

/// Whether two discs touch, i.e. have a point in common.
inline bool touch(const Circle& a, const Circle& b) {
  const double far = a.radius_m + b.radius_m;
  return (a.centre_m - b.centre_m).squaredNorm() <= far * far;
}

}  // namespace sidestep
