// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "agents/planning/grids/navigation/grid_layout.hpp"
#include "common/collision/obstacle_world.hpp"

namespace sidestep {

/// The cells that the obstacles of a world block for a disc, as computed by block_shape(). Remembers the
/// obstacles, and updates only the cells of obstacles that have changed. Does not allocate once warm.
class ObstacleCells {
 public:
  /// Throws std::invalid_argument for an invalid layout, or a radius that is negative or not finite.
  ObstacleCells(const GridLayout& layout, double radius_m);

  /// Adopts the obstacles of a world: the previous world, whose obstacles may have changed, or another one.
  void update(const ObstacleWorld& world);

  bool is_blocked(GridCell cell) const { return obstacles_on_[cell] > 0; }
  /// The cells in which obstacles appeared or disappeared in the last update. A cell may occur twice.
  std::span<const GridCell> changed_cells() const { return changed_cells_; }
  /// The bounds of the shapes that appeared or disappeared in the last update.
  std::span<const Box> changed_bounds() const { return changed_bounds_; }

 private:
  struct Known {
    Shape shape;
    std::vector<GridCell> cells;
    std::uint64_t seen_at = 0;  // the last update in which the world contained it; 0: never, or it is gone
  };

  void add(Known& known, const Shape& shape);
  void remove(Known& known);

  GridLayout layout_;
  double radius_m_;
  std::vector<std::uint32_t> obstacles_on_;  // indexed by cell
  std::vector<Known> known_;                 // indexed by obstacle id
  std::uint64_t updates_ = 0;
  std::vector<GridCell> changed_cells_;
  std::vector<Box> changed_bounds_;
};

}  // namespace sidestep
