// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "common/map/bit_grid.hpp"
#include "common/map/map_grid.hpp"

namespace sidestep {

/// Which square cells of a rectangle are free and which are blocked. Blocked cells are closed squares, and
/// everything outside the map is blocked, the map's border included. Const functions are thread-safe and,
/// except rectangles(), do not allocate. They throw std::invalid_argument for numbers that are not finite.
class OccupancyMap {
 public:
  /// Cells whose bit is 1 are blocked. Throws std::invalid_argument if the grid is invalid (see check) or its
  /// size differs from that of the bits.
  OccupancyMap(const MapGrid& grid, BitGrid blocked);

  const MapGrid& grid() const { return grid_; }
  const BitGrid& blocked() const { return blocked_; }
  Box extent() const { return grid_.extent(); }
  Box box_of(const Cell& cell) const { return grid_.box_of(cell); }
  Cell cell_at(const Vec2& p) const { return grid_.cell_at(p); }
  /// True outside the map.
  bool is_blocked(const Cell& cell) const { return !grid_.has(cell) || blocked_.get(cell.column, cell.row); }

  /// The exact distance from a point to the nearest blocked cell or the outside, but at most `max_m`, which
  /// may be infinite. It is 0 inside a blocked cell or outside. The run time grows with the result.
  double distance_m(const Vec2& p, double max_m = std::numeric_limits<double>::infinity()) const;

  /// Whether a disc that moves straight from one position to another touches a blocked cell or the outside.
  /// Exact in double precision: contact by more than a nanometre is never missed.
  bool touches(const Vec2& from_m, const Vec2& to_m, double radius_m) const;

  /// Calls `call(box)` for boxes that together cover exactly the blocked cells that intersect a closed
  /// region, and the part of the outside that is within one cell of the region. Boxes share no cells: each is
  /// a run of cells in a row, merged with equal runs in the following rows. Stops when `call` returns false,
  /// and then returns false.
  template <typename Call>
  bool for_each_box(const Box& region, const Call& call) const;

  /// Rectangles that together cover exactly the blocked cells, without the outside. Each is maximal, so
  /// rectangles may overlap. Their number is small but not necessarily minimal: for each cell not yet
  /// covered, in rows from the lower left, the largest rectangle with this cell as its corner is chosen, and
  /// extended. nullopt if more than `limit` would be needed.
  std::optional<std::vector<Box>> rectangles(std::size_t limit) const;

 private:
  void check_region(const Box& region) const;
  /// Whether the columns begin, …, end - 1 of a row are a complete run of blocked cells within a range.
  bool is_run(int begin, int end, int row, const CellRange& range) const {
    return blocked_.find_clear(begin, end, row) == end &&
           (begin == range.first.column || !blocked_.get(begin - 1, row)) &&
           (end > range.last.column || !blocked_.get(end, row));
  }
  Box box_of(int begin, int end, int row, int end_row) const {
    return {{grid_.x_m(begin), grid_.y_m(row)}, {grid_.x_m(end), grid_.y_m(end_row)}};
  }
  template <typename Call>
  bool for_each_outside_box(const Box& region, const Call& call) const;

  MapGrid grid_;
  BitGrid blocked_;
};

template <typename Call>
bool OccupancyMap::for_each_box(const Box& region, const Call& call) const {
  check_region(region);
  if (!for_each_outside_box(region, call)) return false;
  const CellRange range = grid_.cells_intersecting(region);
  const int end_column = range.last.column + 1;
  for (int row = range.first.row; row <= range.last.row; ++row) {
    int end = range.first.column;
    while (true) {
      const int begin = blocked_.find_set(end, end_column, row);
      if (begin >= end_column) break;
      end = blocked_.find_clear(begin, end_column, row);
      // A run that equals the run below it belongs to the same box.
      if (row > range.first.row && is_run(begin, end, row - 1, range)) continue;
      int end_row = row + 1;
      while (end_row <= range.last.row && is_run(begin, end, end_row, range)) ++end_row;
      if (!call(box_of(begin, end, row, end_row))) return false;
    }
  }
  return true;
}

template <typename Call>
bool OccupancyMap::for_each_outside_box(const Box& region, const Call& call) const {
  const Box map = extent(), around = inflated(region, grid_.resolution_m);
  if (region.min_m.x() <= map.min_m.x() &&
      !call(Box{around.min_m, {std::min(map.min_m.x(), around.max_m.x()), around.max_m.y()}}))
    return false;
  if (region.max_m.x() >= map.max_m.x() &&
      !call(Box{{std::max(map.max_m.x(), around.min_m.x()), around.min_m.y()}, around.max_m}))
    return false;
  if (region.min_m.y() <= map.min_m.y() &&
      !call(Box{around.min_m, {around.max_m.x(), std::min(map.min_m.y(), around.max_m.y())}}))
    return false;
  return !(region.max_m.y() >= map.max_m.y()) ||
         call(Box{{around.min_m.x(), std::max(map.max_m.y(), around.min_m.y())}, around.max_m});
}

}  // namespace sidestep
