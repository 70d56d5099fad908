// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "common/geometry/vec2.hpp"

namespace sidestep {

/// The nearest place in each of 64 directions from one, as far as `reach_m`, that is free; the nearest first.
/// That one is looked for more closely: it lies within a percent of the nearest there is, where what is in
/// the way is not finer than the directions.
std::vector<Vec2> free_places_near(const Vec2& place_m, double step_m, double reach_m,
                                   const std::function<bool(const Vec2&)>& is_free);

}  // namespace sidestep
