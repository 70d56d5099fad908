// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

namespace sidestep {

/// The planners that can drive robots, for the key `planner` of scenarios. agents/planning/named_planner.hpp
/// makes them.
inline constexpr std::array<std::string_view, 12> kDrivingPlanners{
    "lazy-visibility", "errt",     "bi-errt",  "rrt",         "rrt-connect", "one-shot-prm",
    "dynamic-prm",     "grid-bfs", "grid-dfs", "grid-a-star", "quad-tree",   "trapezoids"};

}  // namespace sidestep
