// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "agents/planning/grids/navigation/cost_grid.hpp"
#include "common/collision/shapes.hpp"

namespace sidestep {

/// Blocks every cell in which the centre of a disc with this radius could touch the shape. Conservative: a
/// disc whose centre lies in a cell that is not blocked never touches the shape. Throws std::invalid_argument
/// if the shape is invalid, or the radius is negative or not finite.
void block_shape(CostGrid& grid, const Shape& shape, double radius_m);

/// Replaces `cells` with the cells that block_shape() would block, each once. Throws in the same cases. Does
/// not allocate once warm.
void find_blocked_cells(const GridLayout& layout, const Shape& shape, double radius_m,
                        std::vector<GridCell>& cells);

/// Blocks cells in the same way for the obstacles in the occupied (non-zero) cells of a bitmap with the
/// grid's layout. Also throws std::invalid_argument if the sizes differ.
void block_occupied(CostGrid& grid, std::span<const std::uint8_t> occupied, double radius_m);

}  // namespace sidestep
