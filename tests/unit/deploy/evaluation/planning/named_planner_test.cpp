// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/planning/named_planner.hpp"

#include <catch2/catch.hpp>

#include "deploy/evaluation/planning/ompl_planner.hpp"
#include "deploy/evaluation/planning/plan_picture.hpp"
#include "deploy/evaluation/planning/worlds.hpp"

using namespace sidestep;

namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t times = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++times;
  return times;
}

}  // namespace

TEST_CASE("every planner plans by its name and shows what it looked at") {
  const PlanWorld world = make_world("u", 3, 1);
  const ObstacleWorld obstacles(world.obstacles);
  const std::string name = GENERATE(from_range(planner_names()));
  CAPTURE(name);
  NamedPlanner planner = make_planner(name);
  CHECK(planner.name == name);
  Rng rng(1);
  for (const PlanQuery& query : world.queries) {
    const DiscDomain domain(obstacles, world.field, world.radius_m, query.start_m, query.goal_m);
    const Plan<Vec2> plan = planner.plan(domain, query.start_m, {}, rng);
    REQUIRE(plan.arrives());
    CHECK(is_valid_way(world, plan.states, 0.005, 1e-9));
    const PlanDrawing drawing = planner.draw();
    CHECK(drawing.tree.size() + drawing.cells.size() > 2);
    const std::string svg = plan_picture(world, query, drawing, plan.states, plan.states);
    CHECK(count(svg, "<polyline") == 2);
    CHECK(count(svg, "<polygon") == world.obstacles.size() + drawing.cells.size());
    CHECK(count(svg, "<circle") == 2 + drawing.cache.size());
    CHECK(svg.find("nan") == std::string::npos);
  }
}

TEST_CASE("a planner with another name is refused") {
  CHECK_THROWS_WITH(make_planner("dijkstra"), Catch::Contains("dijkstra") && Catch::Contains("bi-errt"));
}

TEST_CASE("peers plan valid ways with our check") {
  const PlanWorld world = make_world("u", 3, 1);
  const ObstacleWorld obstacles(world.obstacles);
  for (const std::string& name : ompl_planner_names()) {
    CAPTURE(name);
    OmplPlanner planner(name, world, obstacles, 1);
    for (const PlanQuery& query : world.queries) {
      const BenchedPlan plan = planner.plan(query, 2000);
      REQUIRE(plan.solved);
      CHECK(is_valid_way(world, plan.raw, 0.005, 1e-9));
      CHECK(is_valid_way(world, plan.smooth, 0.005, 1e-9));
      CHECK(plan.smooth.back() == query.goal_m);
    }
  }
}
