// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "common/image/image.hpp"
#include "common/map/bit_grid.hpp"
#include "common/map/map_grid.hpp"
#include "vision/pixel_map/floor_blobs.hpp"

namespace sidestep {

/// The cells of an image: squares of pixels, with row 0 at the top. The last cells are cut off by the image's
/// border.
struct PixelCells {
  static constexpr int kDefaultCell_px = 10;

  /// Precondition: all numbers are positive.
  PixelCells(int width_px, int height_px, int side_px = kDefaultCell_px)
      : cell_px(side_px),
        seen((width_px + side_px - 1) / side_px, (height_px + side_px - 1) / side_px),
        blocked(seen) {}

  /// Precondition: the pixel lies in the image.
  Cell cell_at(const Vec2& pixel) const {
    return {static_cast<int>((pixel.x() + 0.5) / cell_px), static_cast<int>((pixel.y() + 0.5) / cell_px)};
  }
  Vec2 centre_of(const Cell& cell) const {
    return {(cell.column + 0.5) * cell_px - 0.5, (cell.row + 0.5) * cell_px - 0.5};
  }

  int cell_px;
  BitGrid seen;     ///< cells with a pixel of an obstacle
  BitGrid blocked;  ///< cells that a disc's centre must not enter
};

/// Marks the cells of the obstacles. `radius_px` is the disc's radius with its margin; a cell is blocked if a
/// disc whose centre is anywhere in it may touch a seen cell or leave the image. A path through free cells is
/// therefore safe everywhere.
void mark_cells(const ImageView& image, const ColourClasses& classes, const FloorBlobFinder& finder,
                std::span<const ObstacleBlob> obstacles, double radius_px, PixelCells& cells);

}  // namespace sidestep
