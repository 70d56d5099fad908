// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/planning/worlds.hpp"

#include <catch2/catch.hpp>

#include "agents/planning/visibility/tangent_graph.hpp"
#include "deploy/evaluation/planning/world_file.hpp"

using namespace sidestep;

TEST_CASE("worlds come from their seed and all queries can be solved") {
  const std::string name = GENERATE(from_range(world_names()));
  const auto seed = GENERATE(1u, 9u);
  CAPTURE(name, seed);
  const PlanWorld world = make_world(name, 30, seed);
  CHECK(plan_world_text(world) == plan_world_text(make_world(name, 30, seed)));
  CHECK(plan_world_text(world) != plan_world_text(make_world(name, 30, seed + 1)));
  REQUIRE(world.queries.size() == 30);
  const ObstacleWorld obstacles(world.obstacles);
  TangentGraph graph(obstacles, world.field, world.radius_m);
  for (const PlanQuery& query : world.queries) {
    CHECK(is_free(world, query.start_m));
    CHECK(is_free(world, query.goal_m));
    CHECK(graph.plan(query.start_m, query.goal_m).arrives());
  }
}

TEST_CASE("a world with another name is refused") {
  CHECK_THROWS_WITH(make_world("ocean", 1, 1), Catch::Contains("ocean") && Catch::Contains("maze"));
}

TEST_CASE("the dense check finds a way that touches an obstacle or leaves the field") {
  PlanWorld world;
  world.obstacles = {Circle{{0, 0}, 0.5}};
  CHECK(is_valid_way(world, {{-2, 0.61}, {2, 0.61}}, 0.01, 0));
  CHECK_FALSE(is_valid_way(world, {{-2, 0.59}, {2, 0.59}}, 0.01, 0));
  CHECK(is_valid_way(world, {{-2, 0.59}, {2, 0.59}}, 0.01, 0.02));
  CHECK_FALSE(is_valid_way(world, {{-2, 2}, {4.95, 2}}, 0.01, 0));
  CHECK_FALSE(is_valid_way(world, {{0.3, 0}}, 0.01, 0));
}
