// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/dynamic_window/cell_times.hpp"

#include <stdexcept>

namespace sidestep {

ObstacleGrid ObstacleGrid::covering(const Box& area_m, double cell_m) {
  constexpr double kMaxCells = 1e6;
  if (!(cell_m > 0)) throw std::invalid_argument("the side of an obstacle grid's cells has to be positive");
  const Vec2 cells = ((area_m.max_m - area_m.min_m) / cell_m).array().floor() + 1;
  if (!(cells.x() * cells.y() <= kMaxCells))
    throw std::invalid_argument("an obstacle grid has more than a million cells");
  return {area_m.min_m, cell_m, static_cast<int>(cells.x()), static_cast<int>(cells.y())};
}

}  // namespace sidestep
