// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/study/table/study_table.hpp"

namespace sidestep {

/// Measures what changes when a wall of ten cells appears across the straight line to the goal on a free
/// square grid, and when it disappears again: the values of E* that change, the cells that it expands, and
/// the path of a robot at the far side. A field computed from scratch expands all cells.
StudyTable replanning_effects(std::uint32_t side, int walls, std::uint64_t seed);

}  // namespace sidestep
