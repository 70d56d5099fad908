// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/map/occupancy_map.hpp"

namespace sidestep {

/// Sizes for random floor plans. Each is rounded to whole cells, and is at least one cell.
struct FloorPlanSettings {
  double wall_m = 0.15;     ///< wall thickness
  double door_m = 1.0;      ///< door width, at most min_room_m
  double min_room_m = 3.0;  ///< minimum length of a room's shorter side
  double max_room_m = 9.0;  ///< rooms with a longer side are divided
  double corridor_m = 2.0;
  double shelf_m = 0.8;
  double aisle_m = 1.2;          ///< aisle width between shelves, and between shelves and walls
  double corridor_chance = 0.3;  ///< probability that a division is a corridor, if there is space for one
  double shelves_chance = 0.5;   ///< probability that a room has shelves
};

/// A random floor plan of rooms, corridors, doors and shelves within an outer wall. All free cells are
/// connected through shared cell edges; every door is door_m wide. Made by recursive division. The same seed
/// gives the same plan. Throws std::invalid_argument if the grid is invalid, or a size or chance out of
/// range.
[[nodiscard]] OccupancyMap make_floor_plan(std::uint64_t seed, const MapGrid& grid,
                                           const FloorPlanSettings& settings = {});

}  // namespace sidestep
