// SPDX-License-Identifier: Apache-2.0
#include "common/collision/sweep.hpp"

#include <stdexcept>

namespace sidestep {

Sweep::Sweep(const Vec2& from, const Vec2& to, double radius) : from_m(from), to_m(to), radius_m(radius) {
  if (!from.allFinite() || !to.allFinite() || !std::isfinite(radius))
    throw std::invalid_argument("a disc's positions and radius have to be finite");
  if (radius < 0) throw std::invalid_argument("a disc's radius is negative");
}

}  // namespace sidestep
