// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/motion/validity.hpp"

namespace sidestep {

/// What is left of a trajectory from a time on; all of it when it starts later.
Trajectory rest_of(const Trajectory& trajectory, Time from);

/// How near a version that continues `base` from a time on may come to another trajectory: min_separation_m, or as near
/// as the base comes from then on, where that is nearer already. So robots that something brought too near to
/// each other may part, and none may come nearer than it would by doing nothing.
double kept_distance_m(const Trajectory& base, Time from, const Trajectory& other, double min_separation_m);

/// check_place for a version that continues `base`, with its growth: where the base is too near to an
/// obstacle or off the field from the version's start on, the version may be as near, or as far off.
msg::Reason check_place_after(const Version& version, const Trajectory& base, const FloorRules& rules);

}  // namespace sidestep
