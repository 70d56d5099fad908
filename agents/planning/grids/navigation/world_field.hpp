// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/grids/navigation/estar.hpp"
#include "agents/planning/grids/navigation/obstacle_cells.hpp"
#include "common/geometry/field.hpp"

namespace sidestep {

struct WorldFieldSettings {
  GridKernel kernel = GridKernel::kLsm;
  double cell_m = 0.05;             ///< side of a cell
  std::size_t max_cells = 250'000;  ///< on a larger floor, cells are larger
  /// Cells whose centre leaves the disc less than this distance to the nearest obstacle cost more; 0: none.
  double clearance_m = 0;
  /// How much more a cell costs where the disc touches; elsewhere, the square of the lacking part of the
  /// clearance times this.
  double contact_cost = 0;

  bool keeps_clear() const { return clearance_m > 0 && contact_cost > 0; }
};

/// The square cells in which the centre of a disc can be on a floor. They may leave a margin narrower than a
/// cell. Nullopt if the disc does not fit, or the floor is too narrow for that few square cells. Throws
/// std::invalid_argument for invalid settings, floors and radii.
[[nodiscard]] std::optional<GridLayout> layout_of(const Field& floor, double radius_m,
                                                  const WorldFieldSettings& settings);

/// A navigation function for a disc among the obstacles of a world (E*; Philippsen 2004, EPFL thesis 3146).
/// When obstacles or the start change, only values that change or are missing are computed. Does not allocate
/// once warm.
class WorldField {
 public:
  /// `floor` and `radius_m` as they were for the layout.
  WorldField(const GridLayout& layout, const Field& floor, double radius_m,
             const WorldFieldSettings& settings = {});

  bool is_for(const Field& floor, double radius_m) const;
  /// Adopts the obstacles of a world.
  void update(const ObstacleWorld& world);
  /// Sets another goal, in the grid; values are out of date until reach(). Throws std::invalid_argument for a
  /// goal outside.
  void set_goal(const Vec2& goal_m);
  /// Computes the values that a path from this cell needs, and returns whether there is one.
  bool reach(GridCell cell);

  /// Final where reach() was successful and on the path from there.
  const EStar& values() const { return values_; }

 private:
  bool keeps_clear() const { return settings_.keeps_clear(); }
  void update_cost(const ObstacleWorld& world, GridCell cell);
  float cost_of(const ObstacleWorld& world, GridCell cell) const;
  void update_costs_near(const ObstacleWorld& world, const Box& bounds_m);

  Field floor_;
  double radius_m_;
  WorldFieldSettings settings_;
  ObstacleCells obstacles_;
  EStar values_;
  std::uint64_t updates_ = 0;
  std::vector<std::uint64_t> updated_at_;  // by cell
  bool has_goal_ = false;
};

}  // namespace sidestep
