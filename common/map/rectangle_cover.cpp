// SPDX-License-Identifier: Apache-2.0
#include "common/map/occupancy_map.hpp"

namespace sidestep {
namespace {

/// Cells from the lower left one up to, but not including, the end.
struct Rectangle {
  int column, row, end_column, end_row;
};

bool is_column_set(const BitGrid& bits, int column, int row, int end_row) {
  for (; row < end_row; ++row)
    if (!bits.get(column, row)) return false;
  return true;
}

/// The largest rectangle of set bits with this cell at its lower left, extended to the left and downwards.
Rectangle largest_from(const BitGrid& bits, int column, int row) {
  Rectangle best{column, row, column, row};
  long best_cells = 0;
  int end_column = bits.columns();
  for (int top = row; top < bits.rows(); ++top) {
    end_column = bits.find_clear(column, end_column, top);
    if (end_column == column) break;
    const long cells = long{end_column - column} * (top + 1 - row);
    if (cells > best_cells) best = {column, row, end_column, top + 1}, best_cells = cells;
  }
  while (best.column > 0 && is_column_set(bits, best.column - 1, best.row, best.end_row)) --best.column;
  while (best.row > 0 && bits.find_clear(best.column, best.end_column, best.row - 1) == best.end_column)
    --best.row;
  return best;
}

}  // namespace

std::optional<std::vector<Box>> OccupancyMap::rectangles(std::size_t limit) const {
  std::vector<Box> boxes;
  BitGrid uncovered = blocked_;
  for (int row = 0; row < grid_.rows; ++row) {
    int column = 0;
    while ((column = uncovered.find_set(column, grid_.columns, row)) < grid_.columns) {
      if (boxes.size() == limit) return std::nullopt;
      const Rectangle found = largest_from(blocked_, column, row);
      for (int covered = found.row; covered < found.end_row; ++covered)
        uncovered.set_run(found.column, found.end_column, covered, false);
      boxes.push_back(box_of(found.column, found.end_column, found.row, found.end_row));
      column = found.end_column;
    }
  }
  return boxes;
}

}  // namespace sidestep
