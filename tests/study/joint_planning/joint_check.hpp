// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "agents/planning/joint/joint_plan.hpp"

namespace sidestep {

/// Checks the motions of robots: they must lead from starts to goals, keep the required distances and obey
/// the limits. Returns the first fault in one line, or an empty string. Samples positions every millisecond,
/// computed from the phases of the trajectories; shares no code with the planners. `obstacles` are the
/// obstacles of the problem's world. `speed_limits_mps` has the speed limit of each robot, none of which
/// raises that of the problem; if it is empty, the problem's limit applies to all.
[[nodiscard]] std::string fault_of(const JointProblem& problem, std::span<const Shape> obstacles,
                                   std::span<const Course> courses,
                                   std::span<const double> speed_limits_mps = {});

}  // namespace sidestep
