// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/navigation/navigation_planner.hpp"

#include "agents/planning/visibility/tangent_graph.hpp"
#include "deploy/trial/planning/worlds.hpp"
#include "tests/catch.hpp"

namespace sidestep::navigation_planner_test {

NavigationSettings with_kernel(GridKernel kernel) { return {.field = {.kernel = kernel}}; }

struct Totals {
  int solved = 0;
  double mean_length_ratio = 0;  // mean length relative to the shortest path
};

Totals plan_queries(const PlanWorld& world, const NavigationSettings& settings) {
  const ObstacleWorld obstacles(world.obstacles);
  TangentGraph graph(obstacles, world.field, world.radius_m);
  NavigationPlanner planner(settings);
  Rng rng(1);
  Totals totals;
  for (const PlanQuery& query : world.queries) {
    CAPTURE(query.start_m.transpose(), query.goal_m.transpose());
    const DiscDomain domain(obstacles, world.field, world.radius_m, query.start_m, query.goal_m);
    const Plan<Vec2>& plan = planner.plan(domain, query.start_m, {}, rng);
    REQUIRE(plan.states.front() == query.start_m);
    REQUIRE(is_valid_path(world, plan.states, 1e-9));
    if (!plan.arrives()) continue;
    REQUIRE(plan.states.back() == query.goal_m);
    REQUIRE(plan.length == Approx(length_of(domain, plan.states)));
    graph.plan(query.start_m, query.goal_m);
    REQUIRE(plan.length >= graph.shortest_m() * (1 - 1e-9));
    ++totals.solved;
    totals.mean_length_ratio += plan.length / graph.shortest_m();
  }
  totals.mean_length_ratio /= totals.solved;
  return totals;
}

TEST_CASE(
    "navigation functions lead to the goal in all worlds, and E* paths are hardly longer than the shortest") {
  const auto seed = GENERATE(1u, 2u, 3u);
  for (const std::string& name : world_names()) {
    CAPTURE(name, seed);
    const PlanWorld world = make_world(name, 10, seed);
    const Totals estar = plan_queries(world, {});
    const Totals nf1 = plan_queries(world, with_kernel(GridKernel::kNf1));
    // The passages of the narrow worlds may be too narrow for cells.
    CHECK((estar.solved >= 9 || name == "gap" || name == "trap"));
    CHECK(nf1.solved == estar.solved);
    if (estar.solved == 0) continue;
    // Among circles, cells close passages that the shortest path may use.
    CHECK(estar.mean_length_ratio < (name == "circles" ? 1.2 : 1.04));
    CHECK(nf1.mean_length_ratio < 1.3);
    CHECK((name == "empty" || nf1.mean_length_ratio > estar.mean_length_ratio));
  }
}

/// Moves some obstacles at random, and sometimes removes or adds one.
void change(ObstacleWorld& world, Rng& rng) {
  for (std::size_t i = 0; i < world.size(); ++i) {
    if (!rng.chance(0.2)) continue;
    const double y = rng.uniform(-0.4, 0.4), x = rng.uniform(-0.4, 0.4);
    world.move(world.obstacle(i), {x, y});
  }
  if (rng.chance(0.2)) world.remove(world.obstacle(rng.below(world.size())));
  if (!rng.chance(0.2)) return;
  const double y = rng.uniform(-4, 4), x = rng.uniform(-4, 4);
  world.add(Circle{{x, y}, rng.uniform(0.1, 0.5)});
}

TEST_CASE("after obstacles have moved, the path equals that of a newly created planner") {
  const auto kernel = GENERATE(GridKernel::kLsm, GridKernel::kNf1);
  const auto seed = GENERATE(1u, 2u, 3u);
  const PlanWorld world = make_world(seed == 2 ? "mixed" : "circles", 6, seed);
  ObstacleWorld obstacles(world.obstacles);
  NavigationPlanner kept(with_kernel(kernel));
  Rng rng(seed);
  int compared = 0;
  for (int i = 0; i < 40; ++i) {
    change(obstacles, rng);
    // The start changes in every round, the goal and the radius only sometimes.
    const auto& [from, goal] = world.queries[static_cast<std::size_t>(i / 7)];
    const double y = rng.uniform(-0.5, 0.5), x = rng.uniform(-0.5, 0.5);
    const Vec2 start = from + Vec2(x, y);
    const double radius_m = i % 5 == 4 ? 0.13 : 0.1;
    CAPTURE(kernel, seed, i, radius_m, start.transpose(), goal.transpose());
    const DiscDomain domain(obstacles, world.field, radius_m, start, goal);
    NavigationPlanner fresh(with_kernel(kernel));
    const Plan<Vec2>& expected = fresh.plan(domain, start, {}, rng);
    const Plan<Vec2>& plan = kept.plan(domain, start, {}, rng);
    REQUIRE(plan.reason == expected.reason);
    REQUIRE(plan.length == expected.length);
    REQUIRE(plan.states == expected.states);
    compared += plan.arrives() && plan.states.size() > 2;
  }
  CHECK(compared >= 15);
}

TEST_CASE("a replan computes only the cells whose values change") {
  // The start is to the left of a wall, the goal to the right. A circle moves behind the goal.
  ObstacleWorld obstacles({Box{{-0.1, -2}, {0.1, 2}}, Circle{{4, 0}, 0.2}});
  const Vec2 start(-2, 0.1), goal(2, 0);
  NavigationPlanner planner;
  Rng rng(1);
  const auto expansions = [&] {
    const DiscDomain domain(obstacles, {10, 10}, 0.1, start, goal);
    const Plan<Vec2>& plan = planner.plan(domain, start, {}, rng);
    REQUIRE(plan.arrives());
    return plan.samples;
  };
  const std::size_t first = expansions();
  CHECK(first > 5'000);
  CHECK(expansions() == 0);
  obstacles.move(ObstacleId{1}, {0, 0.05});
  const std::size_t next = expansions();
  CHECK(next > 0);
  CHECK(next < first / 10);
}

TEST_CASE("starts and goals in blocked cells are joined to free cells") {
  // Start and goal almost touch the wall, so their cells are blocked. The field's edge also blocks the goal's
  // cell.
  //  ____________
  //      |      g|
  //     s|       |
  //              |
  const PlanWorld world{"wall", {10, 8}, 0.1, {Box{{0, -1}, {0.2, 4}}, Segment{{1, 3.7}, {4, 3.7}}}, {}};
  const ObstacleWorld obstacles(world.obstacles);
  const Vec2 start(-0.1001, 1), goal(4.8999, 3.8999);
  const DiscDomain domain(obstacles, world.field, world.radius_m, start, goal);
  NavigationPlanner planner;
  Rng rng(1);
  const Plan<Vec2>& plan = planner.plan(domain, start, {}, rng);
  REQUIRE(plan.arrives());
  CHECK(plan.states.front() == start);
  CHECK(plan.states.back() == goal);
  CHECK(is_valid_path(world, plan.states, 1e-9));
}

TEST_CASE("a path from deep inside an obstacle or far outside the field leads out") {
  const ObstacleWorld obstacles({Circle{{0, 0}, 1}});
  NavigationPlanner planner;
  Rng rng(1);
  // The straight line to the goal leads deeper into the circle, or through it.
  for (const auto& [start, goal] :
       {std::pair(Vec2(0.2, 0.1), Vec2(-3, -3)), std::pair(Vec2(-7, -0.3), Vec2(3, -0.5))}) {
    CAPTURE(start.transpose());
    const DiscDomain domain(obstacles, {10, 10}, 0.1, start, goal);
    const Plan<Vec2>& plan = planner.plan(domain, start, {}, rng);
    CHECK(plan.start_blocked);
    REQUIRE(plan.arrives());
    REQUIRE(plan.states.size() > 2);
    CHECK(plan.states.front() == start);
    CHECK(plan.states.back() == goal);
    for (std::size_t i = 1; i < plan.states.size(); ++i)
      REQUIRE(domain.check(plan.states[i - 1], plan.states[i]));
  }
}

TEST_CASE("a goal in a cut-off free cell is joined to a connected free cell") {
  // The passages around the goal's cell are wide enough for the disc but too narrow for cells.
  const PlanWorld world{"cell",
                        {10, 10},
                        0.1,
                        {Circle{{2, 0.26}, 0.13}, Circle{{2, -0.26}, 0.13}, Circle{{2.3, 0}, 0.13},
                         Circle{{1.73, 0.22}, 0.005}, Circle{{1.73, -0.22}, 0.005}, Box{{0, -2}, {0.1, 2}}},
                        {}};
  const ObstacleWorld obstacles(world.obstacles);
  const Vec2 start(-2, 0), goal(2.0, 0);
  const DiscDomain domain(obstacles, world.field, world.radius_m, start, goal);
  REQUIRE_FALSE(domain.goal_is_blocked());
  NavigationPlanner planner;
  Rng rng(1);
  const Plan<Vec2>& plan = planner.plan(domain, start, {}, rng);
  REQUIRE(plan.arrives());
  CHECK(plan.states.back() == goal);
  CHECK(is_valid_path(world, plan.states, 1e-9));
}

TEST_CASE("if there is no path, the plan reports an unreachable goal and contains only the start") {
  //  +---+
  //  | g |    s
  //  +---+
  ObstacleWorld obstacles({Box{{-1.1, -1.1}, {1.1, -1}}, Box{{-1.1, 1}, {1.1, 1.1}},
                           Box{{-1.1, -1.1}, {-1, 1.1}}, Box{{1, -1.1}, {1.1, 1.1}}});
  const Vec2 start(3, 0), goal(0, 0);
  NavigationPlanner planner;
  Rng rng(1);
  const auto plan = [&](const Vec2& from, const Vec2& to) {
    const DiscDomain domain(obstacles, {10, 10}, 0.1, from, to);
    return planner.plan(domain, from, {}, rng);
  };
  for (const auto& [from, to] : {std::pair(start, goal), std::pair(goal, start)}) {
    const Plan<Vec2> none = plan(from, to);
    CHECK(none.reason == PlanReason::kUnreachable);
    CHECK(none.states == std::vector<Vec2>{from});
    CHECK(none.length == 0);
  }
  obstacles.move(ObstacleId{3}, {0, 1});
  CHECK(plan(start, goal).arrives());
}

/// The path's largest distance from the line y = 0 between two x coordinates.
double farthest_from_middle_m(const std::vector<Vec2>& path_m, double from_x_m, double to_x_m) {
  double farthest_m = 0;
  for (const Vec2& at : path_m)
    if (at.x() >= from_x_m && at.x() <= to_x_m) farthest_m = std::max(farthest_m, std::abs(at.y()));
  return farthest_m;
}

TEST_CASE("with a clearance cost, paths keep to the middle of a corridor, even if the corridor moves") {
  //  ###############   start and goal lie at opposite walls
  //              g
  //   s
  //  ###############
  ObstacleWorld obstacles({Box{{-4, 0.6}, {4, 2}}, Box{{-4, -2}, {4, -0.6}}});
  NavigationPlanner planner({.field = {.clearance_m = 0.6, .contact_cost = 9}});
  Rng rng(1);
  for (const double shift_m : {0.0, 0.23}) {
    obstacles.move(ObstacleId{0}, {0, shift_m});
    obstacles.move(ObstacleId{1}, {0, shift_m});
    const Vec2 start(-3, shift_m - 0.45), goal(3, shift_m + 0.45);
    const DiscDomain domain(obstacles, {10, 10}, 0.1, start, goal);
    CAPTURE(shift_m);
    REQUIRE(domain.check(start, goal));  // the straight path is free
    std::vector<Vec2> path_m = planner.plan(domain, start, {}, rng).states;
    REQUIRE(path_m.back() == goal);
    for (Vec2& at : path_m) at.y() -= shift_m;
    CHECK(path_m.size() > 100);
    CHECK(farthest_from_middle_m(path_m, -2, 2) < 0.06);
  }
}

TEST_CASE("floors without room for the disc have no path") {
  const ObstacleWorld nothing({Circle{{0, 0}, 0.1}});
  NavigationPlanner planner;
  Rng rng(1);
  for (const Field& floor : {Field{0.1, 5}, Field{5, 0.2}}) {
    const DiscDomain domain(nothing, floor, 0.1, {0, -1}, {0, 1});
    CHECK(planner.plan(domain, {0, -1}, {}, rng).reason == PlanReason::kUnreachable);
    CHECK(planner.directions().empty());
  }
}

}  // namespace sidestep::navigation_planner_test
