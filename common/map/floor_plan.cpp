// SPDX-License-Identifier: Apache-2.0
#include "common/map/floor_plan.hpp"

#include <fmt/format.h>
#include <stdexcept>

#include "common/random/rng.hpp"

namespace sidestep {
namespace {

/// A part of the plan in cells: from the lower left cell up to, but not including, the end.
struct Area {
  int column, row, end_column, end_row;

  int columns() const { return end_column - column; }
  int rows() const { return end_row - row; }
  /// The part between two lines across the longer side; the longer side is along x if `is_wide`.
  Area between(bool is_wide, int begin, int end) const {
    return is_wide ? Area{column + begin, row, column + end, end_row}
                   : Area{column, row + begin, end_column, row + end};
  }
};

void check(const FloorPlanSettings& settings) {
  for (const double size_m : {settings.wall_m, settings.door_m, settings.min_room_m, settings.max_room_m,
                              settings.corridor_m, settings.shelf_m, settings.aisle_m}) {
    if (!(size_m > 0 && size_m <= 1000))
      throw std::invalid_argument(fmt::format("a size of a floor plan is {} m, expected up to 1000", size_m));
  }
  if (settings.door_m > settings.min_room_m || settings.min_room_m > settings.max_room_m)
    throw std::invalid_argument("a floor plan's doors are wider than its rooms, or its rooms have no size");
  for (const double chance : {settings.corridor_chance, settings.shelves_chance}) {
    if (!(chance >= 0 && chance <= 1))
      throw std::invalid_argument(
          fmt::format("a probability of a floor plan is {}, expected 0 to 1", chance));
  }
}

class FloorPlanner {
 public:
  FloorPlanner(std::uint64_t seed, const MapGrid& grid, const FloorPlanSettings& settings)
      : rng_(seed), grid_(grid), settings_(settings), blocked_(grid.columns, grid.rows) {}

  BitGrid plan() {
    const Area all{0, 0, grid_.columns, grid_.rows};
    fill(all, true);
    const int wall = cells(settings_.wall_m);
    const Area inside{wall, wall, grid_.columns - wall, grid_.rows - wall};
    if (inside.columns() > 0 && inside.rows() > 0) {
      fill(inside, false);
      divide(inside);
    }
    return std::move(blocked_);
  }

 private:
  int cells(double size_m) const {
    return std::max(1, static_cast<int>(std::lround(size_m / grid_.resolution_m)));
  }

  void fill(const Area& area, bool is_blocked) {
    for (int row = area.row; row < area.end_row; ++row)
      blocked_.set_run(area.column, area.end_column, row, is_blocked);
  }

  void divide(const Area& area) {
    const bool is_wide = area.columns() > area.rows();
    const int length = std::max(area.columns(), area.rows()), room = cells(settings_.min_room_m);
    const int wall = cells(settings_.wall_m), corridor = cells(settings_.corridor_m);
    const bool is_corridor = length >= 2 * (room + wall) + corridor && rng_.chance(settings_.corridor_chance);
    const int between = is_corridor ? corridor + 2 * wall : wall;
    if (length <= cells(settings_.max_room_m) || length < 2 * room + between) {
      if (rng_.chance(settings_.shelves_chance)) place_shelves(area);
      return;
    }
    const int first =
        room + static_cast<int>(rng_.below(static_cast<std::uint64_t>(length - 2 * room - between + 1)));
    fill(area.between(is_wide, first, first + wall), true);
    if (is_corridor) fill(area.between(is_wide, first + wall + corridor, first + between), true);
    divide(area.between(is_wide, 0, first));
    divide(area.between(is_wide, first + between, length));
    // The door is opened after both sides have been divided, so that no wall inside them ends in the door.
    open_door(area, is_wide, first, first + wall);
    if (is_corridor) open_door(area, is_wide, first + wall + corridor, first + between);
  }

  /// Opens a door in a wall at a random place that is free on both sides. Such a place exists, because the
  /// outermost rooms on both sides are never narrower than a door.
  void open_door(const Area& area, bool is_wide, int begin, int end) {
    const int length = std::min(area.columns(), area.rows()),
              door = std::min(cells(settings_.door_m), length);
    const int places = length - door + 1,
              first = static_cast<int>(rng_.below(static_cast<std::uint64_t>(places)));
    for (int i = 0; i < places; ++i) {
      const int place = (first + i) % places;
      const auto across = [&](int from, int to) {
        return area.between(is_wide, from, to).between(!is_wide, place, place + door);
      };
      if (!is_free(across(begin - 1, begin)) || !is_free(across(end, end + 1))) continue;
      fill(across(begin, end), false);
      return;
    }
  }

  bool is_free(const Area& area) const {
    for (int row = area.row; row < area.end_row; ++row)
      if (blocked_.find_set(area.column, area.end_column, row) != area.end_column) return false;
    return true;
  }

  /// Places shelves parallel to the longer side, with aisles all around.
  void place_shelves(const Area& area) {
    const bool is_wide = area.columns() > area.rows();
    const int length = std::max(area.columns(), area.rows()), width = std::min(area.columns(), area.rows());
    const int aisle = cells(settings_.aisle_m), shelf = cells(settings_.shelf_m);
    if (length <= 2 * aisle) return;
    for (int at = aisle; at + shelf + aisle <= width; at += shelf + aisle)
      fill(area.between(is_wide, aisle, length - aisle).between(!is_wide, at, at + shelf), true);
  }

  Rng rng_;
  MapGrid grid_;
  FloorPlanSettings settings_;
  BitGrid blocked_;
};

}  // namespace

OccupancyMap make_floor_plan(std::uint64_t seed, const MapGrid& grid, const FloorPlanSettings& settings) {
  sidestep::check(grid);
  check(settings);
  return {grid, FloorPlanner(seed, grid, settings).plan()};
}

}  // namespace sidestep
