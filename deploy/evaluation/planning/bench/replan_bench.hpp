// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace sidestep {

inline constexpr std::size_t kReplanCycles = 2670;

/// Prints what replanning costs in each cycle of 1/60 s while 64 circles move to and fro and the robot drives
/// from goal to goal (ReplanCourse). In each cycle all planners get the same query, in an order shuffled by
/// the seed. OMPL's planners are not among them: they cannot leave a start that an obstacle has run into.
/// Returns a sentence for each planner with invalid paths. No names: all planners that support a changing world.
[[nodiscard]] std::vector<std::string> bench_replanning(const std::vector<std::string>& planners,
                                                        std::size_t cycles, std::uint64_t seed);

}  // namespace sidestep
