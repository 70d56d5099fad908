// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/config/scenario.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// A floor with 5 to 30 robots, so dense that they meet (0.5 to 3 m² each), a few obstacles, and so many
/// goals for each that it never comes to the last one within a few minutes.
Scenario sample_scene(Rng& rng);

/// In one line.
std::string floor_in_words(const Scenario& scenario);

}  // namespace sidestep
