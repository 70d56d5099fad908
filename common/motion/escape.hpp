// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/motion/validity.hpp"
#include "common/motion/version.hpp"

namespace sidestep {

/// The part of a trajectory from `from` on; the whole trajectory if it starts later.
Trajectory remaining_trajectory(const Trajectory& trajectory, Time from);

/// The separation required between another trajectory and a version that continues `base` at `from`. It is
/// min_separation_m, or the base's own minimum distance from then on if that is smaller. Thus two robots that
/// an external event brought too close may separate, and neither comes closer than it would by braking alone
/// (coordinator/PROTOCOL.md, rule 4).
double relaxed_separation_m(const Trajectory& base, Time from, const Trajectory& other,
                            double min_separation_m);

/// check_workspace() for a version that continues `base`, with its inflation and the escape rule: where the
/// base, from the version's start on, is too close to an obstacle or off the field, the version may be
/// equally close or equally far off.
[[nodiscard]] Validity check_workspace_with_escape(const Version& version, const Trajectory& base,
                                                   const FloorRules& rules);

}  // namespace sidestep
