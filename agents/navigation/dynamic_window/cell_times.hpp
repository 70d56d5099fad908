// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "agents/navigation/dynamic_window/velocity_grid.hpp"
#include "common/geometry/box.hpp"

namespace sidestep {

/// A grid of square cells around the robot, in the robot's frame.
struct ObstacleGrid {
  Vec2 min_m{0, 0};
  double cell_m = 0;
  int columns = 0, rows = 0;

  /// A grid that covers an area. Throws std::invalid_argument if the side of a cell is not positive or there
  /// would be more than a million cells.
  static ObstacleGrid covering(const Box& area_m, double cell_m);

  std::size_t size() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
  /// The corner at which the cell (column, row) begins.
  Vec2 corner_m(int column, int row) const { return min_m + cell_m * Vec2(column, row); }
  Box cell(int column, int row) const { return {corner_m(column, row), corner_m(column + 1, row + 1)}; }
  /// The cell that contains a point; nullopt if the point lies outside or is not finite.
  std::optional<std::size_t> cell_of(const Vec2& point_m) const {
    const double x = (point_m.x() - min_m.x()) / cell_m, y = (point_m.y() - min_m.y()) / cell_m;
    if (!(x >= 0 && y >= 0 && x < columns && y < rows)) return std::nullopt;
    return index(static_cast<int>(x), static_cast<int>(y));
  }
};

/// For each cell and each velocity, the minimum of the exact times to collision over all points of the cell.
/// Times are computed for an outline that is enlarged by kCellPadding_m, which exceeds all rounding errors.
struct CellTimes {
  ObstacleGrid grid;
  float horizon_s = 0;         ///< represents all later times
  std::vector<float> times_s;  ///< indexed by cell, then slot; horizon_s for velocities beyond the limits
  /// Indexed by cell: whether the outline touches the cell before it moves; if so, the cell's times are 0.
  std::vector<bool> touches_hull;

  std::span<float> of(std::size_t cell) { return std::span(times_s).subspan(cell * kSlots, kSlots); }
  std::span<const float> of(std::size_t cell) const {
    return std::span(times_s).subspan(cell * kSlots, kSlots);
  }
};

inline constexpr double kCellPadding_m = 1e-6;

}  // namespace sidestep
