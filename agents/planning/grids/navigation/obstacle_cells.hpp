// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "agents/planning/grids/navigation/grid_layout.hpp"
#include "common/collision/obstacle_world.hpp"

namespace sidestep {

/// The cells that the obstacles of a world block for a disc, as block_shape() does. Remembers the obstacles,
/// and visits only the cells of those that have changed. Does not allocate once warm.
class ObstacleCells {
 public:
  /// Throws std::invalid_argument for an invalid layout, or a radius that is negative or not finite.
  ObstacleCells(const GridLayout& layout, double radius_m);

  /// Takes over the obstacles of a world: the same one, whose obstacles may have changed, or another.
  void update(const ObstacleWorld& world);

  bool is_blocked(GridCell cell) const { return obstacles_on_[cell] > 0; }
  /// The cells in which obstacles appeared or disappeared in the last update; may hold a cell twice.
  std::span<const GridCell> changed_cells() const { return changed_cells_; }
  /// Where obstacles appeared or disappeared in the last update: the bounds of their shapes.
  std::span<const Box> changed_bounds() const { return changed_bounds_; }

 private:
  struct Known {
    Shape shape;
    std::vector<GridCell> cells;
    std::uint64_t seen_at = 0;  // the last update in which the world had it; 0: never, or it is gone
  };

  void add(Known& known, const Shape& shape);
  void remove(Known& known);

  GridLayout layout_;
  double radius_m_;
  std::vector<std::uint32_t> obstacles_on_;  // by cell
  std::vector<Known> known_;                 // by id
  std::uint64_t updates_ = 0;
  std::vector<GridCell> changed_cells_;
  std::vector<Box> changed_bounds_;
};

}  // namespace sidestep
