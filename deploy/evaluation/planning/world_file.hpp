// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "deploy/evaluation/planning/worlds.hpp"

namespace sidestep {

/// Reads and checks a world file (deploy/evaluation/planning/README.md); throws ScenarioError for anything that is
/// wrong.
PlanWorld load_plan_world(const std::string& path);

/// The same from text; `file_name` stands in messages, and its stem is the world's default name.
PlanWorld parse_plan_world(const std::string& text, const std::string& file_name);

/// The file's text for a world.
std::string plan_world_text(const PlanWorld& world);

}  // namespace sidestep
