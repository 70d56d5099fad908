// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "common/geometry/vec2.hpp"

namespace sidestep {

/// Finds the nearest free position in each of 64 directions, up to `max_distance_m` away, and returns them
/// sorted by distance. `step_m` is the initial step of the search. The nearest position is refined between
/// the directions: its distance is within one percent of the minimum, unless obstacles are finer than the
/// spacing of the directions.
[[nodiscard]] std::vector<Vec2> free_positions_near(const Vec2& position_m, double step_m,
                                                    double max_distance_m,
                                                    const std::function<bool(const Vec2&)>& is_free);

/// Returns only the first position of free_positions_near(), in a fraction of the time. If `can_reach` is
/// given, only positions that it accepts count. Precondition: if it rejects a position, it also rejects all
/// positions behind it in the same direction.
[[nodiscard]] std::optional<Vec2> nearest_free_position(
    const Vec2& position_m, double step_m, double max_distance_m,
    const std::function<bool(const Vec2&)>& is_free, const std::function<bool(const Vec2&)>& can_reach = {});

}  // namespace sidestep
