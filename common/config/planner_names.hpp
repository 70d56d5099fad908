// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

namespace sidestep {

/// The planners that can drive robots, for the key `planner` of scenarios. agents/planning/named_planner.hpp
/// makes them. The others are for comparison: they keep a graph of one world, use up all time, or examine the
/// whole floor.
inline constexpr std::array<std::string_view, 10> kDrivingPlanners{
    "lazy-visibility", "errt",        "bi-errt",     "rrt",       "rrt-connect",
    "one-shot-prm",    "dynamic-prm", "grid-a-star", "quad-tree", "trapezoids"};

}  // namespace sidestep
