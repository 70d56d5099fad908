// SPDX-License-Identifier: Apache-2.0
#include "common/map/image_size.hpp"

#include <fmt/format.h>

#include "common/map/map_grid.hpp"
#include "common/map/map_image.hpp"

namespace sidestep {

void check_image_size(long columns, long rows) {
  if (columns < 1 || rows < 1 || columns > kMaxMapSide || rows > kMaxMapSide || columns * rows > kMaxMapCells)
    throw ImageError(
        fmt::format("it has {} x {} pixels, expected 1 to {} columns and rows, and at most {} "
                    "pixels",
                    columns, rows, kMaxMapSide, kMaxMapCells));
}

}  // namespace sidestep
