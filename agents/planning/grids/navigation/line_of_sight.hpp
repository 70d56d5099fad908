// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "agents/planning/grids/navigation/grid_layout.hpp"

namespace sidestep {

/// Whether `passes(cell)` holds for all cells that a straight segment passes through. For a segment through a
/// common corner of four cells, it must hold for the two cells that the segment crosses and for one of the
/// other two. So a segment may touch a cell's corner but not squeeze between two cells. Positions are in
/// cells from the grid's origin; returns false if one lies outside the grid.
template <typename Passes>
bool sees(const GridLayout& layout, const Vec2& from, const Vec2& to, const Passes& passes) {
  constexpr double kCorner = 1e-9;  // crossings of two borders this close together are one corner
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const auto inside = [&](std::int64_t x, std::int64_t y) {
    return x >= 0 && y >= 0 && x < layout.columns && y < layout.rows &&
           passes(layout.cell(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)));
  };
  if (!from.allFinite() || !to.allFinite()) return false;
  auto x = static_cast<std::int64_t>(std::floor(from.x())),
       y = static_cast<std::int64_t>(std::floor(from.y()));
  const auto end_x = static_cast<std::int64_t>(std::floor(to.x()));
  const auto end_y = static_cast<std::int64_t>(std::floor(to.y()));
  if (!inside(x, y)) return false;
  const Vec2 along = to - from;
  const int step_x = along.x() > 0 ? 1 : -1, step_y = along.y() > 0 ? 1 : -1;
  // Fractions of the segment at its next crossings, for each axis.
  const auto crossing = [](double at, double start, double speed, int step) {
    return speed == 0 ? kNever : (at + (step > 0 ? 1 : 0) - start) / speed;
  };
  std::int64_t left = std::abs(end_x - x) + std::abs(end_y - y);
  while (left > 0) {
    const double cross_x =
        x == end_x ? kNever : crossing(static_cast<double>(x), from.x(), along.x(), step_x);
    const double cross_y =
        y == end_y ? kNever : crossing(static_cast<double>(y), from.y(), along.y(), step_y);
    if (x != end_x && y != end_y && std::abs(cross_x - cross_y) <= kCorner) {
      if (!inside(x + step_x, y) && !inside(x, y + step_y)) return false;
      x += step_x;
      y += step_y;
      left -= 2;
    } else if (cross_x < cross_y) {
      x += step_x;
      --left;
    } else {
      y += step_y;
      --left;
    }
    if (!inside(x, y)) return false;
  }
  return true;
}

}  // namespace sidestep
