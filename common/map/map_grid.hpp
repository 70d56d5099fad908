// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/box.hpp"

namespace sidestep {

/// A cell of a map, counted from the lower left one, which is (0, 0).
struct Cell {
  int column = 0, row = 0;

  friend bool operator==(const Cell&, const Cell&) = default;
};

/// Cells from `first` to `last`, both included. The range is empty if first exceeds last on an axis.
struct CellRange {
  Cell first, last;
};

inline constexpr int kMaxMapSide = 16'384;
inline constexpr long kMaxMapCells = 64L << 20;
inline constexpr double kMinResolution_m = 0.001, kMaxResolution_m = 10;
inline constexpr double kMaxMapOrigin_m = 1e6;

/// The grid of a map: square cells, with columns along x and rows along y.
struct MapGrid {
  int columns = 1, rows = 1;   ///< 1 to kMaxMapSide each, and at most kMaxMapCells cells
  double resolution_m = 0.05;  ///< side of a cell, from kMinResolution_m to kMaxResolution_m
  Vec2 origin_m{0, 0};         ///< the lower left corner, within ±kMaxMapOrigin_m

  /// The border between a column and its left neighbour. Both cells use the same rounded number, so cells
  /// neither overlap nor leave a gap.
  double x_m(int column) const { return origin_m.x() + column * resolution_m; }
  double y_m(int row) const { return origin_m.y() + row * resolution_m; }

  Box box_of(const Cell& cell) const {
    return {{x_m(cell.column), y_m(cell.row)}, {x_m(cell.column + 1), y_m(cell.row + 1)}};
  }
  Box extent() const { return {origin_m, {x_m(columns), y_m(rows)}}; }
  bool has(const Cell& cell) const {
    return cell.column >= 0 && cell.column < columns && cell.row >= 0 && cell.row < rows;
  }
  /// The cell that contains a point. A cell includes its left and lower border but not the others. For a
  /// point outside the map, returns the nearest cell beyond the border: column -1 or `columns`, row -1 or
  /// `rows`.
  Cell cell_at(const Vec2& p) const;
  /// The cells of the map whose closed squares intersect a closed box.
  CellRange cells_intersecting(const Box& box) const;
};

/// Throws std::invalid_argument, with the reason, if a number is out of range.
void check(const MapGrid& grid);

}  // namespace sidestep
