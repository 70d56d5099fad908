// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace sidestep {

/// The velocities that a dynamic window chooses from form a square grid with two axes, for example the speeds
/// of two wheels, each from minus its maximum to plus its maximum. Tables over the grid are stored in tiles
/// of 7 × 9 velocities, so that a tile with one byte per velocity fits a cache line, and a small window
/// touches few tiles.
inline constexpr int kGridSide = 41;
inline constexpr int kTileRows = 7, kTileColumns = 9, kTilesAcross = 5;
inline constexpr std::size_t kTileSlots = 64, kTiles = 30;
inline constexpr std::size_t kSlots = kTiles * kTileSlots;  ///< some slots are unused

/// The slot of the velocity (row, column) in tables; both are 0 .. kGridSide - 1.
constexpr std::size_t slot_of(int row, int column) {
  const int tile = row / kTileRows * kTilesAcross + column / kTileColumns;
  const int within = row % kTileRows * kTileColumns + column % kTileColumns;
  return static_cast<std::size_t>(tile) * kTileSlots + static_cast<std::size_t>(within);
}

/// The speed at an index of an axis.
constexpr double grid_speed(int index, double max_speed) {
  constexpr int kMiddle = kGridSide / 2;
  return max_speed * (index - kMiddle) / kMiddle;
}

/// A range of indices on an axis, including `last`.
struct IndexRange {
  int first = 0, last = -1;
};

/// The indices of speeds that differ from `speed` by at most `max_change`. If there are none, returns the
/// indices next to `speed`, although the axis can only begin to approach these speeds.
inline IndexRange reachable_indices(double speed, double max_change, double max_speed) {
  constexpr double kRounding = 1e-9;
  constexpr int kMiddle = kGridSide / 2;
  const double at = std::clamp(speed / max_speed, -1.0, 1.0) * kMiddle + kMiddle;
  const double reach = std::min(max_change / max_speed * kMiddle, 2.0 * kGridSide) + kRounding;
  const double first = std::ceil(at - reach), last = std::floor(at + reach);
  const auto index = [](double value) { return std::clamp(static_cast<int>(value), 0, kGridSide - 1); };
  if (first > last) return {index(std::floor(at)), index(std::ceil(at))};
  return {index(first), index(last)};
}

/// A rectangle of the grid.
struct GridWindow {
  IndexRange rows, columns;
};

/// Calls `visit(row, column, slot)` for each velocity of a window.
template <typename Visit>
void for_each_velocity(const GridWindow& window, Visit visit) {
  for (int row = window.rows.first; row <= window.rows.last; ++row) {
    for (int column = window.columns.first; column <= window.columns.last; ++column)
      visit(row, column, slot_of(row, column));
  }
}

/// Calls `visit(tile)` for each tile that holds velocities of a window.
template <typename Visit>
void for_each_tile(const GridWindow& window, Visit visit) {
  for (int row = window.rows.first / kTileRows; row <= window.rows.last / kTileRows; ++row) {
    for (int column = window.columns.first / kTileColumns; column <= window.columns.last / kTileColumns;
         ++column)
      visit(static_cast<std::size_t>(row) * kTilesAcross + static_cast<std::size_t>(column));
  }
}

}  // namespace sidestep
