// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/grids/navigation/estar.hpp"

namespace sidestep {

/// The direction of steepest descent, interpolated between the centres of cells; of length 1. Zero at the
/// goal, in blocked cells, outside the grid, and where the goal cannot be reached. Values must be final up to
/// that of the position's cell.
[[nodiscard]] Vec2 direction_at(const EStar& field, const Vec2& position_m);

/// Follows the field from a position to the goal and writes the vertices of the path, both ends included.
/// The path crosses no blocked cell; it may touch one's corner. Returns whether it arrives: false, with an
/// empty path, from outside the grid, from blocked cells, and from where the goal cannot be reached. Always
/// ends, since every step lowers the interpolated value by a minimum: where the gradient does not, the path
/// continues through the centres of cells, each lower than the last. Does not allocate once warm.
[[nodiscard]] bool trace(const EStar& field, const Vec2& from_m, std::vector<Vec2>& path_m);

}  // namespace sidestep
