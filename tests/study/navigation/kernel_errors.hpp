// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/study/table/study_table.hpp"

namespace sidestep {

/// Measures the errors of each kernel's values on a free square grid with the goal in the middle, with and
/// without exact initialisation, by direction from the goal. Includes all cells at least a quarter of the
/// side away from the goal.
StudyTable errors_by_direction(std::uint32_t side);

/// Measures the errors of values relative to exact lengths, and the lengths of traced paths, on square grids
/// with a fraction of single cells blocked at random. Includes all cells that are reached.
StudyTable errors_among_obstacles(std::uint32_t side, int grids, std::uint64_t seed);

}  // namespace sidestep
