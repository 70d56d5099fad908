// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "agents/safety/safety_search.hpp"

namespace sidestep {

/// The accelerations with which a robot creeps away from all strangers that may reach it before it stops from
/// creeping, or from the nearest one that may reach it soon; those that lead away most directly first. Empty
/// if there is no such stranger, if the robot is faster than it may creep, or if each direction leads nearer
/// to one of the strangers. `min_separation_m` is the robot's radius plus the margin.
[[nodiscard]] std::vector<Vec2> accelerations_away(const SearchQuery& query, double min_separation_m);

}  // namespace sidestep
