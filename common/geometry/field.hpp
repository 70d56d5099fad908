// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/vec2.hpp"

namespace sidestep {

/// The rectangle in which robots may drive: centred on the origin, length along x, width along y.
struct Field {
  double length_m = 9;
  double width_m = 6;

  /// Whether a disc at this position lies within the field.
  bool contains(const Vec2& p, double radius_m) const {
    return std::abs(p.x()) + radius_m <= length_m / 2 && std::abs(p.y()) + radius_m <= width_m / 2;
  }
};

}  // namespace sidestep
