// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/collision/shapes.hpp"
#include "common/geometry/field.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// Where to come from and where to go.
struct PlanQuery {
  Vec2 start_m{0, 0}, goal_m{0, 0};
};

/// A floor with obstacles for a disc-shaped robot, and what is asked of planners on it.
struct PlanWorld {
  std::string name;
  Field field{10, 10};
  double radius_m = 0.1;
  std::vector<Shape> obstacles;
  std::vector<PlanQuery> queries;
};

/// The names that make_world knows, in the order of the benchmark's table.
const std::vector<std::string>& world_names();

/// A world with so many queries, all from the seed: empty, circles, mixed, maze, gap, trap or u. Each query
/// has a free start and a free goal; throws std::invalid_argument for another name.
PlanWorld make_world(const std::string& name, std::size_t queries, std::uint64_t seed);

/// So many circles as dense as the 64 of "circles": the more, the larger the field.
PlanWorld make_circles(std::size_t circles, std::size_t queries, std::uint64_t seed);

/// Adds queries, up to so many, from one free place to another at least half the field's length away where
/// there is a way.
void ask_across(PlanWorld& world, std::size_t queries, Rng& rng);

/// Whether the robot stands in the field and touches no obstacle, compared one by one.
bool is_free(const PlanWorld& world, const Vec2& place_m);

/// Whether a way keeps in the field and off the obstacles, by a distance query every `step_m`: independent of
/// what planners ask. `slack_m`: how much too near a place may be.
bool is_valid_way(const PlanWorld& world, const std::vector<Vec2>& path_m, double step_m, double slack_m);

}  // namespace sidestep
