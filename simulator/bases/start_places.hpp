// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "simulator/bases/base_world.hpp"

namespace sidestep {

/// Where the robots of a simulation start.
enum class StartPlaces : std::uint8_t {
  kScenario,  ///< where the scenario says
  kLine,      ///< in a row along the field's upper edge, 0.3 m apart, as robots of the league's simulators do
  kShuffled,  ///< each robot of the scenario at the place of another one
};

/// Moves the robots on the floor to their start places. Throws std::invalid_argument if a place is outside
/// the field.
void place_robots(BaseWorld& world, StartPlaces places, std::uint64_t seed);

}  // namespace sidestep
