// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/evaluation/study/table/study_table.hpp"

namespace sidestep {

/// Errors of the values of each kernel on a free square grid with the goal in its middle, with and without
/// exact initialisation, by direction from the goal: of all cells at least a quarter of the side away.
StudyTable errors_by_direction(std::uint32_t side);

/// Errors of values over exact lengths, and lengths of traced paths, on square grids with a part of single
/// cells blocked at random; on each, all cells that are reached.
StudyTable errors_among_obstacles(std::uint32_t side, int grids, std::uint64_t seed);

}  // namespace sidestep
