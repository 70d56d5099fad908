// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "agents/planning/joint/joint_plan.hpp"

namespace sidestep {

/// What is wrong with the motions of robots, in one line; empty if nothing is: they lead from starts to
/// goals, keep the required distances and obey the limits. Samples positions every millisecond, and computes
/// them from the phases of the trajectories; shares no code with the planners. `obstacles`: those of the
/// problem's world.
[[nodiscard]] std::string fault_of(const JointProblem& problem, std::span<const Shape> obstacles,
                                   std::span<const Course> courses);

}  // namespace sidestep
