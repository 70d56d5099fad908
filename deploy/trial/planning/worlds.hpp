// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/collision/shapes.hpp"
#include "common/geometry/field.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// A start and a goal.
struct PlanQuery {
  Vec2 start_m{0, 0}, goal_m{0, 0};
};

/// A field with obstacles for a disc-shaped robot, and the queries that planners must answer in it.
struct PlanWorld {
  std::string name;
  Field field{10, 10};
  double radius_m = 0.1;
  std::vector<Shape> obstacles;
  std::vector<PlanQuery> queries;
};

/// The names that make_world() knows, in the order of the benchmark's table.
const std::vector<std::string>& world_names();

/// Generates a world of this kind (empty, circles, mixed, maze, gap, trap or u) with this number of queries
/// from the seed. Every query is solvable according to FreeSpace. Throws std::invalid_argument for other
/// names.
PlanWorld make_world(const std::string& name, std::size_t queries, std::uint64_t seed);

/// Generates this number of circles with the same density as the 64 circles of "circles"; the field grows
/// with the number.
PlanWorld make_circles(std::size_t circles, std::size_t queries, std::uint64_t seed);

/// Adds solvable queries until the world has `queries` queries. Start and goal are free positions at least
/// half the field's length apart.
void add_queries_across(PlanWorld& world, std::size_t queries, Rng& rng);

/// Whether a robot at this position lies within the field and touches no obstacle. Compares exactly with each
/// obstacle.
[[nodiscard]] bool is_free(const PlanWorld& world, const Vec2& position_m);

/// Whether a path stays within the field and clear of the obstacles. Compares each segment exactly with each
/// obstacle, independently of the structures that planners query. `slack_m` is the depth by which the robot's
/// disc may overlap an obstacle. A path without positions is not valid.
[[nodiscard]] bool is_valid_path(const PlanWorld& world, const std::vector<Vec2>& path_m, double slack_m);

}  // namespace sidestep
