// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/building_sampler.hpp"

#include <cmath>

#include "common/map/floor_plan.hpp"

namespace sidestep {
namespace {

constexpr double kCell_m = 0.05;

}  // namespace

std::shared_ptr<const FloorMap> sample_building(const Field& field, double radius_m, Rng& rng) {
  MapGrid grid;
  grid.resolution_m = kCell_m;
  grid.columns = static_cast<int>(std::ceil(field.length_m / kCell_m));
  grid.rows = static_cast<int>(std::ceil(field.width_m / kCell_m));
  grid.origin_m = -0.5 * kCell_m * Vec2(grid.columns, grid.rows);
  FloorPlanSettings plan;
  plan.wall_m = rng.uniform(0.05, 0.15);
  plan.door_m = 2 * radius_m + rng.uniform(0.15, 0.7);
  plan.min_room_m = plan.door_m + rng.uniform(0.6, 2);
  plan.max_room_m = plan.min_room_m * rng.uniform(1.5, 3);
  plan.corridor_m = plan.door_m * rng.uniform(1, 2);
  plan.shelf_m = rng.uniform(0.2, 0.6);
  plan.aisle_m = plan.door_m;
  plan.shelves_chance = rng.uniform(0, 0.6);
  BitGrid blocked = make_floor_plan(rng.bits(), grid, plan).blocked();
  for (std::uint64_t specks = rng.below(20); specks > 0; --specks) {
    const auto column = static_cast<int>(rng.below(static_cast<std::uint64_t>(grid.columns)));
    const auto row = static_cast<int>(rng.below(static_cast<std::uint64_t>(grid.rows)));
    blocked.set(column, row);
  }
  return std::make_shared<const FloorMap>(OccupancyMap(grid, std::move(blocked)));
}

}  // namespace sidestep
