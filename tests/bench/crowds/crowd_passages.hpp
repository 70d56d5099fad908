// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/bench/crowds/crowd_floor.hpp"

namespace sidestep {

/// A range from which a length is drawn.
struct LengthRange {
  double min_m = 0, max_m = 0;
};

/// A wall along y with a passage in it, and the robots on both sides.
struct PassageSettings {
  std::size_t robots_per_side = 4;
  LengthRange width{};     ///< of the passage
  LengthRange length{};    ///< of the passage, which is the thickness of the wall
  double max_shift_m = 0;  ///< maximum distance of the passage from the centre line of the field
  double rest_length_m = 1.6, rest_width_m = 2;  ///< size of the area in which the robots of a side rest
};

/// Two groups swap sides through a passage. Throws std::invalid_argument if the field is too small.
Scenario passage_scene(const PassageSettings& settings, const Field& field, Rng& rng);

/// As passage_scene(), through a thin wall or, with the same probability, a wall with a pillar on each side
/// of the door.
Scenario doorway_scene(const PassageSettings& settings, const Field& field, Rng& rng);

/// Four corridors meet in the middle of the field. Two robots start in each, and drive to other corridors,
/// two to each. The corridors are wide enough for two robots, but a robot at rest in the middle blocks its
/// corridor.
Scenario junction_scene(const LengthRange& width, const Field& field, Rng& rng);

}  // namespace sidestep
