// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>

#include "common/map/bit_grid.hpp"

namespace sidestep {

/// Squared distance that is returned for a grid without blocked cells.
inline constexpr std::int32_t kNoBlockedCell = std::numeric_limits<std::int32_t>::max();

/// Receives one row of squared distances in cells; the row is valid during the call only.
using DistanceRowHandler = std::function<void(int row, std::span<const std::int32_t> squared)>;

/// The exact squared Euclidean distance from the centre of each cell to the centre of the nearest blocked
/// cell of the grid, in cells. Each row is passed to `take` once, from the last to the first. A pass over the
/// columns finds the distances within each column; a pass over the rows finds the lower envelope of parabolas
/// (Felzenszwalb and Huttenlocher 2012). The envelope is found without divisions, as the lower convex hull of
/// the points (x, x² + distance²). Linear in the number of cells; at most 16,384 columns and rows.
void distance_transform(const BitGrid& blocked, const DistanceRowHandler& take);

}  // namespace sidestep
