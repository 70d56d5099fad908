// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/floor_plan.hpp"
#include "common/map/occupancy_map.hpp"
#include "common/random/rng.hpp"

namespace sidestep::test {

/// Cells that are blocked independently of each other.
inline BitGrid noise(Rng& rng, int columns, int rows, double blocked_part) {
  BitGrid bits(columns, rows);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      if (rng.chance(blocked_part)) bits.set(column, row);
  return bits;
}

/// A map of 1 x 1 to 140 x `max_rows` cells: all free, all blocked, noise, few blocked cells, few free cells,
/// or rooms.
inline OccupancyMap random_map(Rng& rng, int max_rows) {
  MapGrid grid;
  grid.columns = 1 + static_cast<int>(rng.below(rng.chance(0.5) ? 12 : 140));
  grid.rows = 1 + static_cast<int>(rng.below(static_cast<std::uint64_t>(rng.chance(0.5) ? 12 : max_rows)));
  grid.resolution_m = rng.chance(0.5) ? 0.05 : rng.uniform(0.01, 1);
  const double x_m = rng.uniform(-20, 20), y_m = rng.uniform(-20, 20);
  grid.origin_m = rng.chance(0.3) ? Vec2(0, 0) : Vec2(x_m, y_m);
  const std::uint64_t kind = rng.below(6), seed = rng.bits();
  if (kind == 5) {
    FloorPlanSettings rooms;
    rooms.wall_m = rooms.corridor_m = rooms.shelf_m = rooms.aisle_m = 2 * grid.resolution_m;
    rooms.door_m = 3 * grid.resolution_m;
    rooms.min_room_m = 5 * grid.resolution_m;
    rooms.max_room_m = 20 * grid.resolution_m;
    return make_floor_plan(seed, grid, rooms);
  }
  constexpr double kBlockedParts[] = {0, 1, 0.2, 0.01, 0.95};
  return {grid, noise(rng, grid.columns, grid.rows, kBlockedParts[kind])};
}

/// A position in or near a map, often on the border or a corner of a cell.
inline Vec2 random_map_position(Rng& rng, const MapGrid& grid) {
  const Box around = inflated(grid.extent(), 0.5 * grid.resolution_m);
  const double x_m = rng.uniform(around.min_m.x(), around.max_m.x());
  const double y_m = rng.uniform(around.min_m.y(), around.max_m.y());
  Vec2 position(x_m, y_m);
  const Cell cell = grid.cell_at(position);
  if (rng.chance(0.2)) position.x() = grid.x_m(cell.column);
  if (rng.chance(0.2)) position.y() = grid.y_m(cell.row);
  return position;
}

/// The boxes of all blocked cells, found by checking each cell.
inline std::vector<Box> blocked_boxes(const OccupancyMap& map) {
  std::vector<Box> boxes;
  const MapGrid& grid = map.grid();
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      if (map.is_blocked({column, row})) boxes.push_back(map.box_of({column, row}));
  return boxes;
}

/// The distance from a point to a solid box, measured to the box's nearest point.
inline double distance_to_box(const Vec2& p, const Box& box) {
  return (p - p.cwiseMax(box.min_m).cwiseMin(box.max_m)).norm();
}

}  // namespace sidestep::test
