// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/collision/shapes.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// A shape of any kind, up to 0.8 m large, in or near a rectangle of 3 by 2 m at the origin.
inline Shape random_shape(Rng& rng) {
  const double x = rng.uniform(-0.5, 3.5), y = rng.uniform(-0.5, 2.5), size = rng.uniform(0.01, 0.8);
  const Vec2 at(x, y);
  switch (rng.below(4)) {
    case 0:
      return Circle{at, size};
    case 1:
      return Box{at, at + Vec2(size, size / 2)};
    case 2:
      return ConvexPolygon{{at, at + Vec2(size, 0), at + Vec2(0, size)}};
    default:
      return Segment{at, at + Vec2(-size, size / 3)};
  }
}

}  // namespace sidestep
