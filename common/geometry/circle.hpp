// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/vec2.hpp"

namespace sidestep {

struct Circle {
  Vec2 centre_m{0, 0};
  double radius_m = 0;
};

}  // namespace sidestep
