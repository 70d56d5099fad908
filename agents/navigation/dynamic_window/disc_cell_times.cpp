// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/dynamic_window/disc_cell_times.hpp"

#include <limits>
#include <stdexcept>

#include "common/collision/time_of_impact.hpp"

namespace sidestep {

double disc_time_to_collision_s(const Vec2& point_m, double radius_m, const Vec2& velocity_mps) {
  const double beyond_m2 = point_m.squaredNorm() - radius_m * radius_m;
  if (beyond_m2 <= 0) return 0;
  const double approach = point_m.dot(velocity_mps), speed2 = velocity_mps.squaredNorm();
  const double under_root = approach * approach - speed2 * beyond_m2;
  if (approach <= 0 || under_root < 0) return std::numeric_limits<double>::infinity();
  return beyond_m2 / (approach + std::sqrt(under_root));
}

CellTimes disc_cell_times(double radius_m, double speed_mps, double cell_m, double horizon_s) {
  if (!(radius_m > 0) || !(speed_mps > 0) || !(horizon_s > 0))
    throw std::invalid_argument("a disc's radius, speed and horizon have to be positive");
  const double padded_m = radius_m + kCellPadding_m, reach_m = padded_m + speed_mps * horizon_s;
  const Box area{Vec2(-reach_m, -reach_m), Vec2(reach_m, reach_m)};
  CellTimes times{ObstacleGrid::covering(area, cell_m), static_cast<float>(horizon_s), {}, {}};
  times.times_s.assign(times.grid.size() * kSlots, times.horizon_s);
  times.touches_hull.assign(times.grid.size(), false);
  const Vec2 origin(0, 0);
  for (int row = 0; row < times.grid.rows; ++row) {
    for (int column = 0; column < times.grid.columns; ++column) {
      const std::size_t cell = times.grid.index(column, row);
      const Shape shape = times.grid.cell(column, row);
      const double distance_m = signed_distance(origin, shape) - padded_m;
      times.touches_hull[cell] = distance_m <= 0;
      if (distance_m >= speed_mps * horizon_s) continue;
      for_each_velocity({{0, kGridSide - 1}, {0, kGridSide - 1}}, [&](int i, int j, std::size_t slot) {
        const Vec2 velocity = grid_velocity(i, j, speed_mps);
        if (!is_within_speed(velocity, speed_mps)) return;
        const auto contact = time_of_impact(Sweep(origin, horizon_s * velocity, padded_m), shape);
        if (contact) times.of(cell)[slot] = static_cast<float>(*contact * horizon_s);
      });
    }
  }
  return times;
}

}  // namespace sidestep
