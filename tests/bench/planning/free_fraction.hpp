// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/collision/obstacle_world.hpp"

namespace sidestep {

/// The fraction of a straight motion, 0 to 1, that a disc can make from a free position: up to a micrometre
/// short of the first contact, because the position of contact is blocked; 1 if the whole motion is free.
[[nodiscard]] double free_fraction(const ObstacleWorld& obstacles, const Vec2& from_m, const Vec2& to_m,
                                   double radius_m);

}  // namespace sidestep
