// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "agents/planning/grids/navigation/cost_grid.hpp"
#include "common/collision/shapes.hpp"

namespace sidestep {

/// Blocks every cell in which the centre of a disc with this radius could touch the shape. Conservative: a
/// disc whose centre lies in a cell that is not blocked does not touch. Throws std::invalid_argument for an
/// invalid shape or a radius that is negative or not finite.
void block_shape(CostGrid& grid, const Shape& shape, double radius_m);

/// Replaces `cells` by the cells that block_shape() blocks, each once. The same errors. Does not allocate
/// once warm.
void find_blocked_cells(const GridLayout& layout, const Shape& shape, double radius_m,
                        std::vector<GridCell>& cells);

/// The same for obstacles that fill the occupied cells (not 0) of a bitmap with the grid's layout. Throws
/// std::invalid_argument if the sizes differ too.
void block_occupied(CostGrid& grid, std::span<const std::uint8_t> occupied, double radius_m);

}  // namespace sidestep
