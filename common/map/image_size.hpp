// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/map_image.hpp"

namespace sidestep {

/// Throws ImageError if an image has no pixels or is larger than a map may be.
void check_image_size(long columns, long rows);

/// Sets a cell to the state that its pixel encodes.
inline void set_cell(ImageCells& cells, int column, int row, MapCellState state, UnknownCells unknown) {
  cells.unknown += state == MapCellState::kUnknown;
  if (state == MapCellState::kOccupied ||
      (state == MapCellState::kUnknown && unknown == UnknownCells::kBlocked))
    cells.blocked.set(column, row);
}

}  // namespace sidestep
