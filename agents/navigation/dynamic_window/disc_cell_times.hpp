// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/navigation/dynamic_window/cell_times.hpp"

namespace sidestep {

/// The time after which a disc that starts at the origin and moves in a straight line touches a point. 0 if
/// it already touches it, infinite if it never does.
[[nodiscard]] double disc_time_to_collision_s(const Vec2& point_m, double radius_m, const Vec2& velocity_mps);

/// Rows of the velocity grid are velocities along x; columns are velocities along y.
inline Vec2 grid_velocity(int row, int column, double speed_mps) {
  return {grid_speed(row, speed_mps), grid_speed(column, speed_mps)};
}

/// Whether a velocity of the grid is within the speed limit. The grid's corners exceed it.
inline bool is_within_speed(const Vec2& velocity_mps, double speed_mps) {
  constexpr double kRounding = 1e-9;
  return velocity_mps.squaredNorm() <= speed_mps * speed_mps * (1 + kRounding);
}

/// The exact times to collision of all cells that an omnidirectional disc can reach within the horizon, for
/// all velocities of the grid. Throws std::invalid_argument if a number is not positive, or the grid would be
/// too large.
[[nodiscard]] CellTimes disc_cell_times(double radius_m, double speed_mps, double cell_m, double horizon_s);

}  // namespace sidestep
