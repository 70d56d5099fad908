// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/safety/safety_search.hpp"
#include "agents/safety/trajectory_index.hpp"

namespace sidestep {

/// Finds candidates for a robot whose base is in conflict: too near to another robot's version or to an
/// obstacle, or off the field. Candidates come no nearer to the conflicting versions and obstacles than the
/// base does. The desired acceleration comes first, then accelerations away from the conflicts. Returns no
/// candidates if the base is free of conflicts, because SafetySearch handles that case.
[[nodiscard]] SearchResult search_escape(const SearchQuery& query, const Version& base,
                                         const TrajectoryIndex& others, const FloorRules& rules);

}  // namespace sidestep
