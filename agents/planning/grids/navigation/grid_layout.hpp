// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "common/geometry/vec2.hpp"

namespace sidestep {

/// A cell of a regular grid: row * columns + column.
using GridCell = std::uint32_t;

/// The position and size of a regular grid of square cells.
struct GridLayout {
  std::uint32_t columns = 0;  ///< along x
  std::uint32_t rows = 0;     ///< along y
  double resolution_m = 0.1;  ///< side of a cell
  Vec2 origin_m{0, 0};        ///< corner of the grid with the smallest coordinates

  std::size_t size() const { return std::size_t{columns} * rows; }
  GridCell cell(std::uint32_t column, std::uint32_t row) const { return row * columns + column; }
  Vec2 centre_of(GridCell cell) const {
    return origin_m + resolution_m * Vec2(cell % columns + 0.5, cell / columns + 0.5);
  }
  /// A position in cells from the origin.
  Vec2 in_cells(const Vec2& position_m) const { return (position_m - origin_m) / resolution_m; }
  /// The cell that contains a position; nullopt outside the grid.
  std::optional<GridCell> cell_at(const Vec2& position_m) const {
    const Vec2 at = in_cells(position_m);
    if (!(at.x() >= 0 && at.y() >= 0 && at.x() < columns && at.y() < rows)) return std::nullopt;
    return cell(static_cast<std::uint32_t>(at.x()), static_cast<std::uint32_t>(at.y()));
  }

  bool operator==(const GridLayout&) const = default;
};

/// Throws std::invalid_argument for a grid without cells, with more than 32,000 columns or rows, with a
/// resolution that is not positive, or with numbers that are not finite.
void check(const GridLayout& layout);

}  // namespace sidestep
