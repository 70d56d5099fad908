// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace sidestep {

struct FloorSpec;

/// The planners that can drive robots, for the key `planner` of scenarios
/// (agents/planning/named_planner.hpp). Six are local methods that follow another planner's paths. Planners
/// that are not listed are for comparison: they keep a graph of one world, always use the whole time limit,
/// or examine the whole floor.
inline constexpr std::array<std::string_view, 19> kDrivingPlanners{
    "lazy-visibility", "errt",
    "bi-errt",         "rrt",
    "rrt-connect",     "one-shot-prm",
    "dynamic-prm",     "grid-a-star",
    "estar",           "nf1",
    "quad-tree",       "trapezoids",
    "dynamic-window",  "nf1-dynamic-window",
    "bubble-band",     "nf1-band-dynamic-window",
    "potential-field", "nf1-potential-field",
    "estar-clearance"};

/// Names of the planners that can drive robots, for program options.
inline std::vector<std::string> driving_planners() {
  return {kDrivingPlanners.begin(), kDrivingPlanners.end()};
}

/// Makes all robots use this planner. Empty: keep the scenario's planners.
void use_planner(FloorSpec& floor, const std::string& planner);

}  // namespace sidestep
