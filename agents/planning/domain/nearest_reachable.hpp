// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/domain/disc_domain.hpp"

namespace sidestep {

/// The position nearest to the goal among all positions that are connected to the start, for goals that no
/// path reaches. Follows passages that are wider than the spacing of a grid of about four thousand cells, or
/// wider than the disc's radius if that is larger. Then slides from the nearest cells towards the goal as far
/// as obstacles allow. Returns nullopt if the start is blocked and cannot be left.
[[nodiscard]] std::optional<Vec2> nearest_reachable(const DiscDomain& domain, const Vec2& start_m,
                                                    const Vec2& goal_m);

}  // namespace sidestep
