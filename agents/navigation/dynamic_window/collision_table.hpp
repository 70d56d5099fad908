// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "agents/navigation/dynamic_window/cell_times.hpp"
#include "agents/navigation/dynamic_window/quantiser.hpp"

namespace sidestep {

/// Times to collision, indexed by velocity.
using VelocityTimes = std::array<float, kSlots>;

/// A look-up table with the time to collision of each cell for each velocity, one byte per entry. The time of
/// a cell is never later than the time of any of its points. Cells that touch the outline are not in the
/// table: their points must be treated exactly, because otherwise a robot next to a wall could not move.
class CollisionTable {
 public:
  CollisionTable(const CellTimes& times, const Quantiser& quantiser);

  /// For the tiles of a window, computes the minimum over the cells of all points. Points outside the grid
  /// cannot be reached within the horizon. Appends the points in cells that touch the outline to `exact`.
  /// Skips points that are not finite. Does not allocate once warm.
  void minimum(std::span<const Vec2> points_m, const GridWindow& window, VelocityTimes& times_s,
               std::vector<Vec2>& exact);

  /// The stored time; for cells out of reach, the horizon; nullopt for cells that touch the outline.
  std::optional<float> time_s(std::size_t cell, std::size_t slot) const;
  const ObstacleGrid& grid() const { return grid_; }
  /// Number of cells that are within reach and do not touch the outline.
  std::size_t stored_cells() const { return cells_; }
  std::size_t bytes() const { return table_.size() * kTileSlots; }
  /// The number of distinct cells that contained points in the last call of minimum().
  std::size_t last_cells() const { return found_.size(); }

 private:
  /// The entries of one cell in one tile.
  struct alignas(kTileSlots) Line {
    std::uint8_t numbers[kTileSlots];
  };
  static constexpr std::int32_t kOutOfReach = -1, kOnHull = -2;

  void find_cells(std::span<const Vec2> points_m, std::vector<Vec2>& exact);

  ObstacleGrid grid_;
  Quantiser quantiser_;
  // Indexed by cell: its place among the stored cells, or kOutOfReach or kOnHull.
  std::vector<std::int32_t> place_;
  std::size_t cells_ = 0;
  std::vector<Line> table_;                // indexed by tile, then place
  std::vector<std::uint32_t> last_query_;  // indexed by place: the last query with points in the cell
  std::uint32_t query_ = 0;
  std::vector<std::uint32_t> found_;  // places found in this query
};

}  // namespace sidestep
