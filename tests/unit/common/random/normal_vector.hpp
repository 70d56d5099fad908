// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/vec2.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// Both coordinates are standard normal.
inline Vec2 normal_vector(Rng& rng) {
  // y is drawn first, because the evaluation order of arguments is unspecified.
  const double y = rng.normal(), x = rng.normal();
  return {x, y};
}

}  // namespace sidestep
