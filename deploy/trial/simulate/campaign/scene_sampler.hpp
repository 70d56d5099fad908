// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "common/config/scenario.hpp"
#include "common/random/rng.hpp"
#include "deploy/trial/simulate/system/driven_bases.hpp"

namespace sidestep {

/// Samples a scene with 5 to 30 robots (at most 16 if they are such driven bases), dense enough that they
/// interact (0.5 to 3 m² each), up to five obstacles, and enough goals per robot that none reaches its last
/// one within a few minutes.
Scenario sample_scene(Rng& rng, const std::optional<DrivenBaseSettings>& bases = std::nullopt);

/// A description of the scene in one line.
std::string scene_summary(const Scenario& scenario);

/// Adds opponents that cross the floor among the robots to some scenes.
void sample_opponents(Scenario& scenario, Rng& rng);

/// Gives the robots of some scenes lasers, and replaces the opponents of these scenes with walking people.
void sample_lasers(Scenario& scenario, Rng& rng);

/// In every second scene, chooses one random planner for all robots, or one for each robot. Excludes local
/// methods that ignore paths, because these may stop for ever.
void sample_planners(Scenario& scenario, Rng& rng);

}  // namespace sidestep
