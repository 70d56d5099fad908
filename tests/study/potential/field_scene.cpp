// SPDX-License-Identifier: Apache-2.0
#include "tests/study/potential/field_scene.hpp"

#include <algorithm>

#include "deploy/trial/planning/free_space.hpp"

namespace sidestep {
namespace {

// Minimum clearance of the widest path to the goal in every scene.
constexpr double kExtraRadius_m = 0.09;

void add_u(PlanWorld& world, Rng& rng) {
  const double back_m = rng.uniform(0.3, 0.9), half_m = rng.uniform(0.6, 1.0), arm_m = rng.uniform(0.8, 1.5),
               y = rng.uniform(-0.3, 0.3), thickness_m = 0.1;
  world.obstacles = {
      Box{{back_m, y - half_m}, {back_m + thickness_m, y + half_m}},
      Box{{back_m - arm_m, y + half_m - thickness_m}, {back_m, y + half_m}},
      Box{{back_m - arm_m, y - half_m}, {back_m, y - half_m + thickness_m}},
  };
}

void add_wall(PlanWorld& world, Rng& rng) {
  const double x = rng.uniform(-0.5, 0.5), y = rng.uniform(-0.3, 0.3), half_m = rng.uniform(0.6, 1.2);
  world.obstacles = {Box{{x, y - half_m}, {x + 0.1, y + half_m}}};
}

void add_corridor(PlanWorld& world, double spare_m, Rng& rng) {
  constexpr double kHalfLength_m = 1.5, kHalfHeight_m = 1.6;
  const double y = rng.uniform(-0.2, 0.2), half_m = world.radius_m + spare_m / 2;
  world.obstacles = {Box{{-kHalfLength_m, y + half_m}, {kHalfLength_m, kHalfHeight_m}},
                     Box{{-kHalfLength_m, -kHalfHeight_m}, {kHalfLength_m, y - half_m}}};
}

void add_gap(PlanWorld& world, double spare_m, Rng& rng) {
  const double y = rng.uniform(-0.2, 0.2), half_m = world.radius_m + spare_m / 2;
  const double above_m = rng.uniform(0.4, 0.8), below_m = rng.uniform(0.4, 0.8);
  world.obstacles = {Circle{{0, y + half_m + above_m}, above_m}, Circle{{0, y - half_m - below_m}, below_m}};
}

void add_discs(PlanWorld& world, Rng& rng) {
  constexpr int kDiscs = 12;
  world.obstacles.clear();
  for (int i = 0; i < kDiscs; ++i) {
    const double y = rng.uniform(-1.8, 1.8), x = rng.uniform(-1.8, 1.8), radius_m = rng.uniform(0.15, 0.4);
    world.obstacles.emplace_back(Circle{{x, y}, radius_m});
  }
}

/// A floor with start and goal; obstacles between them are added later.
PlanWorld open_floor(Rng& rng) {
  PlanWorld world;
  world.field = {8, 5};
  world.radius_m = 0.1;
  const double start_y = rng.uniform(-0.3, 0.3), goal_y = rng.uniform(-0.3, 0.3);
  world.queries = {{{-2.7, start_y}, {2.7, goal_y}}};
  return world;
}

bool is_solvable(PlanWorld world) {
  world.radius_m += kExtraRadius_m;
  const PlanQuery query = world.queries.front();
  return is_free(world, query.start_m) && is_free(world, query.goal_m) &&
         FreeSpace(world).connects(query.start_m, query.goal_m);
}

}  // namespace

const char* name_of(FieldScene scene) {
  constexpr std::array kNames{"U", "wall", "corridor", "gap", "discs"};
  return kNames[static_cast<std::size_t>(scene)];
}

PlanWorld field_scene(FieldScene scene, std::uint64_t seed) {
  Rng rng(seed);
  while (true) {
    PlanWorld world = open_floor(rng);
    world.name = name_of(scene);
    const double spare_m = rng.uniform(kMinSpare_m, kMaxSpare_m);
    switch (scene) {
      case FieldScene::kU:
        add_u(world, rng);
        break;
      case FieldScene::kWall:
        add_wall(world, rng);
        break;
      case FieldScene::kCorridor:
        add_corridor(world, spare_m, rng);
        break;
      case FieldScene::kGap:
        add_gap(world, spare_m, rng);
        break;
      case FieldScene::kDiscs:
        add_discs(world, rng);
        break;
    }
    if (is_solvable(world)) return world;
  }
}

PlanWorld corridor_scene(double spare_m, std::uint64_t seed) {
  Rng rng(seed);
  PlanWorld world = open_floor(rng);
  world.name = name_of(FieldScene::kCorridor);
  add_corridor(world, spare_m, rng);
  return world;
}

}  // namespace sidestep
