// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/grids/navigation/estar.hpp"
#include "agents/planning/grids/navigation/obstacle_cells.hpp"
#include "common/geometry/field.hpp"

namespace sidestep {

inline constexpr double kFieldCell_m = 0.05;            ///< side of a cell
inline constexpr std::size_t kMaxFieldCells = 250'000;  ///< cells are larger if the floor would need more

struct WorldFieldSettings {
  GridKernel kernel = GridKernel::kLsm;
  /// A cell costs more if a disc at its centre is nearer than this to an obstacle; 0: no cell costs more.
  double clearance_m = 0;
  /// Additional cost of a cell where the disc touches. Elsewhere this is multiplied by the square of the
  /// missing fraction of the clearance.
  double contact_cost = 0;

  bool keeps_clear() const { return clearance_m > 0 && contact_cost > 0; }
};

/// A grid of square cells for the positions of a disc's centre on a floor. It may leave a margin narrower
/// than a cell. nullopt if the disc does not fit, or if the floor is so narrow that it needs more than
/// kMaxFieldCells square cells. Throws std::invalid_argument for invalid settings, floors and radii.
[[nodiscard]] std::optional<GridLayout> layout_of(const Field& floor, double radius_m,
                                                  const WorldFieldSettings& settings);

/// A navigation function for a disc among the obstacles of a world (E*; Philippsen 2004, EPFL thesis 3146).
/// When obstacles or the start change, only values that change or are missing are computed. Does not allocate
/// once warm.
class WorldField {
 public:
  /// Precondition: `layout` was made for `floor` and `radius_m`; see layout_of().
  WorldField(const GridLayout& layout, const Field& floor, double radius_m,
             const WorldFieldSettings& settings = {});

  bool is_for(const Field& floor, double radius_m) const;
  /// Adopts the obstacles of a world.
  void update(const ObstacleWorld& world);
  /// Sets another goal in the grid; values are out of date until reach(). Throws std::invalid_argument if the
  /// goal is outside the grid.
  void set_goal(const Vec2& goal_m);
  /// Computes the values that a path from this cell needs, and returns whether a path exists.
  bool reach(GridCell cell);

  /// Values are final in cells for which reach() was successful, and on the paths from these cells.
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
  std::vector<std::uint64_t> updated_at_;  // indexed by cell
  bool has_goal_ = false;
};

}  // namespace sidestep
