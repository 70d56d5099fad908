// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/map/occupancy_map.hpp"

namespace sidestep {

/// Sizes of random floor plans; each is rounded to whole cells, at least one.
struct FloorPlanSettings {
  double wall_m = 0.15;     ///< thickness
  double door_m = 1.0;      ///< at most min_room_m
  double min_room_m = 3.0;  ///< shortest side of rooms
  double max_room_m = 9.0;  ///< longer rooms are divided
  double corridor_m = 2.0;
  double shelf_m = 0.8;
  double aisle_m = 1.2;          ///< between shelves, and between shelves and walls
  double corridor_chance = 0.3;  ///< that a division is a corridor, if there is room for it
  double shelves_chance = 0.5;   ///< that a room has shelves
};

/// A random floor plan of rooms, corridors, doors and shelves within an outer wall. All free cells are
/// connected by edges of cells; every door is door_m wide. Made by recursive division. The same seed gives
/// the same plan. Throws std::invalid_argument if the grid is invalid, or a size or chance out of range.
[[nodiscard]] OccupancyMap make_floor_plan(std::uint64_t seed, const MapGrid& grid,
                                           const FloorPlanSettings& settings = {});

}  // namespace sidestep
