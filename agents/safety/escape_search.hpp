// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/safety/safety_search.hpp"
#include "agents/safety/trajectory_index.hpp"

namespace sidestep {

/// Ways out for a robot whose base is too near to somebody already, or in an obstacle's room or off the
/// field: what comes no nearer than the base does, the wish first, then accelerations away from whoever is
/// too near. Nothing where the base is clear of everybody: then it is for the safety search to find a way.
SearchResult search_escape(const SearchQuery& query, const Version& base, const TrajectoryIndex& others,
                           const FloorRules& rules);

}  // namespace sidestep
