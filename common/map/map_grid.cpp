// SPDX-License-Identifier: Apache-2.0
#include "common/map/map_grid.hpp"

#include <fmt/format.h>
#include <stdexcept>

namespace sidestep {
namespace {

/// The index of the last of `count` + 1 borders at or before `at_m`; -1 if there is none.
template <typename Border>
int last_border(double at_m, double origin_m, double resolution_m, int count, const Border& border_m) {
  if (!(at_m >= origin_m)) return -1;
  if (at_m >= border_m(count)) return count;
  int index = std::min(static_cast<int>((at_m - origin_m) / resolution_m), count - 1);
  // Rounding may have moved the quotient across a border.
  while (border_m(index) > at_m) --index;
  while (border_m(index + 1) <= at_m) ++index;
  return index;
}

}  // namespace

Cell MapGrid::cell_at(const Vec2& p) const {
  return {last_border(p.x(), origin_m.x(), resolution_m, columns, [&](int i) { return x_m(i); }),
          last_border(p.y(), origin_m.y(), resolution_m, rows, [&](int i) { return y_m(i); })};
}

CellRange MapGrid::cells_intersecting(const Box& box) const {
  CellRange range{cell_at(box.min_m), cell_at(box.max_m)};
  // Squares are closed: a square whose upper border is the box's lower border meets the box.
  if (range.first.column > 0 && x_m(range.first.column) >= box.min_m.x()) --range.first.column;
  if (range.first.row > 0 && y_m(range.first.row) >= box.min_m.y()) --range.first.row;
  range.first.column = std::max(range.first.column, 0);
  range.first.row = std::max(range.first.row, 0);
  range.last.column = std::min(range.last.column, columns - 1);
  range.last.row = std::min(range.last.row, rows - 1);
  return range;
}

void check(const MapGrid& grid) {
  if (grid.columns < 1 || grid.columns > kMaxMapSide || grid.rows < 1 || grid.rows > kMaxMapSide) {
    throw std::invalid_argument(fmt::format("a map of {} x {} cells, expected 1 to {} columns and rows",
                                            grid.columns, grid.rows, kMaxMapSide));
  }
  if (long{grid.columns} * grid.rows > kMaxMapCells) {
    throw std::invalid_argument(fmt::format("a map of {} x {} cells, expected at most {} cells", grid.columns,
                                            grid.rows, kMaxMapCells));
  }
  if (!(grid.resolution_m >= kMinResolution_m && grid.resolution_m <= kMaxResolution_m)) {
    throw std::invalid_argument(fmt::format("a map's resolution is {} m, expected {} to {}",
                                            grid.resolution_m, kMinResolution_m, kMaxResolution_m));
  }
  if (!(grid.origin_m.cwiseAbs().maxCoeff() <= kMaxMapOrigin_m) || !grid.origin_m.allFinite()) {
    throw std::invalid_argument(fmt::format("a map's origin is ({}, {}) m, expected coordinates up to {:g}",
                                            grid.origin_m.x(), grid.origin_m.y(), kMaxMapOrigin_m));
  }
}

}  // namespace sidestep
