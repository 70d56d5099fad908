// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace sidestep {

inline constexpr std::size_t kReplanCycles = 2670;

/// Prints the cost of replanning in each cycle of 1/60 s while 64 circles move back and forth and the robot
/// drives from goal to goal (ReplanCourse). In each cycle all planners get the same query, in an order
/// shuffled by the seed. OMPL's planners are excluded, because they cannot plan from a start that an obstacle
/// has moved onto. Returns a sentence for each planner with invalid paths. If `planners` is empty, compares
/// all planners that support a changing world.
[[nodiscard]] std::vector<std::string> bench_replanning(const std::vector<std::string>& planners,
                                                        std::size_t cycles, std::uint64_t seed);

}  // namespace sidestep
