// SPDX-License-Identifier: Apache-2.0
#include "common/map/image_size.hpp"

#include <fmt/format.h>

#include "common/map/map_grid.hpp"
#include "common/map/map_image.hpp"

namespace sidestep {

long bytes_left(std::istream& file) {
  const std::streamoff at = file.tellg();
  file.seekg(0, std::ios::end);
  const std::streamoff end = file.tellg();
  file.seekg(at);
  return static_cast<long>(end - at);
}

void check_image_size(long columns, long rows) {
  if (columns < 1 || rows < 1 || columns > kMaxMapSide || rows > kMaxMapSide || columns * rows > kMaxMapCells)
    throw MapImageError(
        fmt::format("it has {} x {} pixels, expected 1 to {} columns and rows, and at most {} "
                    "pixels",
                    columns, rows, kMaxMapSide, kMaxMapCells));
}

}  // namespace sidestep
