// SPDX-License-Identifier: Apache-2.0
#include "vision/pixel_map/pixel_cells.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

void mark_seen(const ImageView& image, const ColourClasses& classes, const FloorBlobFinder& finder,
               const ObstacleBlob& blob, PixelCells& cells) {
  for (int y = blob.top_px; y <= blob.bottom_px; ++y) {
    for (int x = blob.left_px; x <= blob.right_px; ++x) {
      if (!finder.is_obstacle(pixel_at(image, x, y), classes)) continue;
      // Marks the cells between this pixel and its foot, in steps shorter than a cell.
      const Vec2 top(x, y), down = finder.foot_of(top) - top;
      const int steps = static_cast<int>(down.norm() / (0.7 * cells.cell_px)) + 1;
      for (int step = 0; step <= steps; ++step) {
        const Cell cell = cells.cell_at(top + step / double(steps) * down);
        if (cell.column >= 0 && cell.row >= 0 && cell.column < cells.seen.columns() &&
            cell.row < cells.seen.rows())
          cells.seen.set(cell.column, cell.row);
      }
    }
  }
}

/// Blocks the cells around a seen cell within the disc's radius, row by row.
void block_around(const Cell& seen, double radius_px, PixelCells& cells) {
  const int reach = static_cast<int>(radius_px / cells.cell_px) + 1;
  for (int dy = -reach; dy <= reach; ++dy) {
    const int row = seen.row + dy;
    if (row < 0 || row >= cells.blocked.rows()) continue;
    const double gap_px = std::max(0, std::abs(dy) - 1) * cells.cell_px;
    const double rest2 = radius_px * radius_px - gap_px * gap_px;
    if (rest2 < 0) continue;
    const int columns = static_cast<int>(std::sqrt(rest2) / cells.cell_px) + 1;
    cells.blocked.set_run(std::max(0, seen.column - columns),
                          std::min(cells.blocked.columns(), seen.column + columns + 1), row);
  }
}

/// Blocks the cells in which a disc would extend beyond the image.
void block_border(const ImageView& image, double radius_px, PixelCells& cells) {
  const int columns = cells.blocked.columns(), side = cells.cell_px;
  for (int row = 0; row < cells.blocked.rows(); ++row) {
    const bool is_near = row * side < radius_px || image.height_px - (row + 1) * side < radius_px;
    for (int column = 0; column < columns; ++column) {
      if (is_near || column * side < radius_px || image.width_px - (column + 1) * side < radius_px)
        cells.blocked.set(column, row);
    }
  }
}

}  // namespace

void mark_cells(const ImageView& image, const ColourClasses& classes, const FloorBlobFinder& finder,
                std::span<const ObstacleBlob> obstacles, double radius_px, PixelCells& cells) {
  for (int row = 0; row < cells.seen.rows(); ++row) {
    cells.seen.set_run(0, cells.seen.columns(), row, false);
    cells.blocked.set_run(0, cells.seen.columns(), row, false);
  }
  for (const ObstacleBlob& blob : obstacles) mark_seen(image, classes, finder, blob, cells);
  for (int row = 0; row < cells.seen.rows(); ++row) {
    for (int column = cells.seen.find_set(0, cells.seen.columns(), row); column < cells.seen.columns();
         column = cells.seen.find_set(column + 1, cells.seen.columns(), row))
      block_around({column, row}, radius_px, cells);
  }
  block_border(image, radius_px, cells);
}

}  // namespace sidestep
