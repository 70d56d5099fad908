// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/navigation/blocked_cells.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace sidestep {
namespace {

constexpr double kRounding_m = 1e-9;

void check_radius(double radius_m) {
  if (!(radius_m >= 0) || !std::isfinite(radius_m))
    throw std::invalid_argument("the radius of a disc must be finite and not negative");
}

/// Whether a shape comes within a given distance of a square cell.
bool is_near(const Shape& shape, const Box& shape_bounds, const Box& square, double distance_m) {
  if (const auto* circle = std::get_if<Circle>(&shape))
    return signed_distance(circle->centre_m, square) <= circle->radius_m + distance_m;
  const auto contains = [&](const Vec2& p) { return signed_distance(p, square) <= 0; };
  if (contains(shape_bounds.min_m) && contains(shape_bounds.max_m)) return true;
  const std::array<Vec2, 4> corners = corners_of(square);
  for (std::size_t i = 0; i < 4; ++i) {
    const Segment edge{corners[i], corners[(i + 1) % 4]};
    if (squared_distance(edge, shape) <= distance_m * distance_m) return true;
  }
  return false;
}

/// The index of the cell that contains a coordinate, clamped to the grid.
std::uint32_t clipped(double in_cells, std::uint32_t count) {
  return static_cast<std::uint32_t>(std::clamp(std::floor(in_cells), 0.0, static_cast<double>(count - 1)));
}

}  // namespace

void block_shape(CostGrid& grid, const Shape& shape, double radius_m) {
  std::vector<GridCell> cells;
  find_blocked_cells(grid.layout(), shape, radius_m, cells);
  for (const GridCell cell : cells) grid.block(cell);
}

void find_blocked_cells(const GridLayout& layout, const Shape& shape, double radius_m,
                        std::vector<GridCell>& cells) {
  check(shape);
  check_radius(radius_m);
  cells.clear();
  const double distance_m = radius_m + kRounding_m;
  const Box shape_bounds = bounds(shape);
  const Box reach = inflated(shape_bounds, distance_m);
  const Vec2 first = layout.in_cells(reach.min_m), last = layout.in_cells(reach.max_m);
  if (last.x() < 0 || last.y() < 0 || first.x() > layout.columns || first.y() > layout.rows) return;
  const Vec2 cell_size(layout.resolution_m, layout.resolution_m);
  const double circumradius_m = layout.resolution_m * std::sqrt(0.5) * (1 + 1e-9) + kRounding_m;
  for (std::uint32_t row = clipped(first.y(), layout.rows); row <= clipped(last.y(), layout.rows); ++row) {
    for (std::uint32_t column = clipped(first.x(), layout.columns);
         column <= clipped(last.x(), layout.columns); ++column) {
      const GridCell cell = layout.cell(column, row);
      const Vec2 centre = layout.centre_of(cell);
      // The distance of the cell's centre decides, except for cells near the border of the blocked region.
      const double centre_m = signed_distance(centre, shape);
      if (centre_m > distance_m + circumradius_m) continue;
      if (centre_m <= distance_m ||
          is_near(shape, shape_bounds, {centre - cell_size / 2, centre + cell_size / 2}, distance_m))
        cells.push_back(cell);
    }
  }
}

void block_occupied(CostGrid& grid, std::span<const std::uint8_t> occupied, double radius_m) {
  check_radius(radius_m);
  const GridLayout& layout = grid.layout();
  if (occupied.size() != layout.size()) throw std::invalid_argument("the bitmap and the grid differ in size");
  const double radius = (radius_m + kRounding_m) / layout.resolution_m;  // in cells
  // How many columns to either side of an occupied cell are within the radius, in the row `up` rows away; -1:
  // none, not even the cell straight above.
  const auto reach_at = [&](std::int64_t up) {
    const auto gap = static_cast<double>(std::max<std::int64_t>(up - 1, 0));
    if (gap > radius) return std::int64_t{-1};
    return static_cast<std::int64_t>(std::min(std::sqrt(radius * radius - gap * gap), 1e9)) + 1;
  };
  const std::int64_t columns = layout.columns, rows = layout.rows;
  // Number of blocked runs that start, minus the number of blocked runs that end.
  std::vector<std::int32_t> starts(layout.columns + 1);
  for (std::int64_t row = 0; row < rows; ++row) {
    std::fill(starts.begin(), starts.end(), 0);
    const auto furthest = static_cast<std::int64_t>(std::min(radius, 1e9)) + 1;
    for (std::int64_t other = std::max<std::int64_t>(row - furthest, 0);
         other <= std::min(row + furthest, rows - 1); ++other) {
      const std::int64_t reach = reach_at(std::abs(other - row));
      for (std::int64_t column = 0; column < columns && reach >= 0; ++column) {
        if (!occupied[static_cast<std::size_t>(other * columns + column)]) continue;
        ++starts[static_cast<std::size_t>(std::max<std::int64_t>(column - reach, 0))];
        --starts[static_cast<std::size_t>(std::min(column + reach + 1, columns))];
      }
    }
    std::int32_t depth = 0;
    for (std::int64_t column = 0; column < columns; ++column) {
      depth += starts[static_cast<std::size_t>(column)];
      if (depth > 0) grid.block(static_cast<GridCell>(row * columns + column));
    }
  }
}

}  // namespace sidestep
