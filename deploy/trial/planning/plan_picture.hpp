// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "agents/planning/named_planner.hpp"
#include "deploy/trial/planning/worlds.hpp"

namespace sidestep {

/// Draws the world, its explored part, and the path before and after smoothing, as SVG. The subtitle says
/// which planner found what.
[[nodiscard]] std::string plan_picture(const PlanWorld& world, const PlanQuery& query,
                                       const PlanDrawing& drawing, const std::vector<Vec2>& path_m,
                                       const std::vector<Vec2>& smoothed_m, const std::string& subtitle = "");

}  // namespace sidestep
