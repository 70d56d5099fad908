// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "deploy/trial/planning/worlds.hpp"

namespace sidestep {

/// Reads and checks a world file; see deploy/trial/planning/README.md. Throws ConfigError with file and
/// line for the first error.
[[nodiscard]] PlanWorld load_plan_world(const std::string& path);

/// Parses and checks the text of a world file. `file_name` appears in messages, and its stem is the world's
/// default name.
[[nodiscard]] PlanWorld parse_plan_world(const std::string& text, const std::string& file_name);

/// The text of a world file for a world.
[[nodiscard]] std::string plan_world_text(const PlanWorld& world);

}  // namespace sidestep
