// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/config/scenario.hpp"
#include "tests/bench/crowds/crowd_result.hpp"
#include "tests/bench/crowds/neighbourhood_planner.hpp"

namespace sidestep {

/// Plans the motions of all robots of a scene together: what a planner achieves that knows everything before
/// anybody drives. Robots obey the scene's limits but keep no margin: their discs must not overlap, and there
/// is no noise or delay. The courses are in the order of the scene's robots. Throws std::invalid_argument if
/// the scene has opponents or a map, or if a robot does not have exactly one goal.
[[nodiscard]] JointPlan plan_reference(const Scenario& scenario, std::uint64_t seed,
                                       const NeighbourhoodSettings& settings = {});

/// How the robots of a scene drive along a plan, without the processor time. A plan in which an independent
/// check finds a fault, such as discs that overlap or a robot that exceeds the speed limit of its goal,
/// counts as a violation.
[[nodiscard]] CrowdResult crowd_result_of(const Scenario& scenario, const JointPlan& plan);

/// How the robots of a scene drive along plan_reference(). The processor time is that of the plan, divided by
/// the robots and by the control cycles until the last arrival. Throws as plan_reference() does.
[[nodiscard]] CrowdResult run_reference(const Scenario& scenario, std::uint64_t seed);

/// A lower bound of the ratio of every method: the mean, over the robots that have a way to drive, of the
/// time for the shortest path around the obstacles, from rest to rest without other robots, over
/// straight_line_time_s(). Infinite if no path leads to a goal. Robots that may stop short of the goal,
/// within its tolerance, can arrive up to a hundredth earlier. Throws as plan_reference() does.
[[nodiscard]] double lower_bound_ratio(const Scenario& scenario);

}  // namespace sidestep
