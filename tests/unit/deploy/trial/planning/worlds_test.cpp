// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/planning/worlds.hpp"

#include "agents/planning/visibility/tangent_graph.hpp"
#include "deploy/trial/planning/free_space.hpp"
#include "deploy/trial/planning/world_file.hpp"
#include "tests/catch.hpp"

namespace sidestep::worlds_test {

TEST_CASE("a seed determines its world, and all queries are solvable") {
  const std::string name = GENERATE(from_range(world_names()));
  const auto seed = GENERATE(1u, 9u);
  CAPTURE(name, seed);
  const PlanWorld world = make_world(name, 30, seed);
  CHECK(plan_world_text(world) == plan_world_text(make_world(name, 30, seed)));
  CHECK(plan_world_text(world) != plan_world_text(make_world(name, 30, seed + 1)));
  REQUIRE(world.queries.size() == 30);
  const ObstacleWorld obstacles(world.obstacles);
  TangentGraph graph(obstacles, world.field, world.radius_m);
  const FreeSpace free_space(world);
  for (const PlanQuery& query : world.queries) {
    CHECK(is_free(world, query.start_m));
    CHECK(is_free(world, query.goal_m));
    CHECK(free_space.connects(query.start_m, query.goal_m));
    CHECK(graph.plan(query.start_m, query.goal_m).arrives());
  }
}

TEST_CASE("an unknown world name is rejected") {
  CHECK_THROWS_WITH(make_world("ocean", 1, 1), ContainsSubstring("ocean") && ContainsSubstring("maze"));
}

TEST_CASE("the path check rejects paths that touch an obstacle or leave the field") {
  PlanWorld world;
  world.obstacles = {Circle{{0, 0}, 0.5}};
  CHECK(is_valid_path(world, {{-2, 0.61}, {2, 0.61}}, 0));
  CHECK_FALSE(is_valid_path(world, {{-2, 0.59}, {2, 0.59}}, 0));
  CHECK(is_valid_path(world, {{-2, 0.59}, {2, 0.59}}, 0.02));
  CHECK_FALSE(is_valid_path(world, {{-2, 2}, {4.95, 2}}, 0));
  CHECK_FALSE(is_valid_path(world, {{0.3, 0}}, 0));
  CHECK_FALSE(is_valid_path(world, {}, 0));
}

TEST_CASE("the path check rejects paths with micrometre contacts between their corners") {
  PlanWorld world;
  world.radius_m = 0.1;
  for (const Shape& shape :
       std::initializer_list<Shape>{Circle{{0, 0}, 0.5}, Box{{-0.5, -0.5}, {0.5, 0.5}},
                                    Segment{{0, 0}, {0, 0.5}}, ConvexPolygon{{{-1, 0}, {1, 0}, {0, 0.5}}}}) {
    world.obstacles = {shape};
    CHECK(is_valid_path(world, {{-3, -1}, {-3, 0.600001}, {3, 0.600001}}, 0));
    CHECK_FALSE(is_valid_path(world, {{-3, -1}, {-3, 0.599999}, {3, 0.599999}}, 0));
  }
}

}  // namespace sidestep::worlds_test
