// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/grids/navigation/estar.hpp"

namespace sidestep {

/// The direction of steepest descent as a unit vector, interpolated between the centres of cells. Zero at the
/// goal, in blocked cells, outside the grid, and where the goal cannot be reached. Precondition: all values
/// up to the value of the position's cell are final.
[[nodiscard]] Vec2 direction_at(const EStar& field, const Vec2& position_m);

/// Follows the field from a position to the goal and writes the vertices of the path, both ends included. The
/// path crosses no blocked cell, but may touch a corner of one. Returns whether it arrives: false, with an
/// empty path, if it starts outside the grid, in a blocked cell, or where the goal cannot be reached. It
/// always terminates, because every step lowers the interpolated value by a minimum amount: where the
/// gradient does not achieve that, the path continues through the centres of cells, each lower than the
/// previous centre. Does not allocate once warm.
[[nodiscard]] bool trace(const EStar& field, const Vec2& from_m, std::vector<Vec2>& path_m);

}  // namespace sidestep
