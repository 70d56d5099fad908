// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/grid_planner.hpp"
#include "agents/planning/grids/navigation/navigation_planner.hpp"
#include "agents/planning/grids/quad_tree.hpp"
#include "agents/planning/grids/trapezoidal_decomposition.hpp"
#include "agents/planning/visibility/lazy_visibility.hpp"
#include "agents/planning/visibility/tangent_graph.hpp"
#include "deploy/trial/planning/worlds.hpp"
#include "tests/catch.hpp"

namespace sidestep::cells_test {

struct Outcome {
  int solved = 0;
  double mean_length_ratio = 0;  // mean length relative to the shortest path
};

template <typename Planner>
Outcome plan_world(Planner planner, const std::string& name, std::uint64_t seed) {
  const PlanWorld world = make_world(name, 10, seed);
  const ObstacleWorld obstacles(world.obstacles);
  TangentGraph graph(obstacles, world.field, world.radius_m);
  Rng rng(seed);
  Outcome outcome;
  for (const PlanQuery& query : world.queries) {
    CAPTURE(name, seed, query.start_m.transpose(), query.goal_m.transpose());
    const DiscDomain domain(obstacles, world.field, world.radius_m, query.start_m, query.goal_m);
    const Plan<Vec2>& plan = planner.plan(domain, query.start_m, {}, rng);
    REQUIRE(plan.states.front() == query.start_m);
    REQUIRE(is_valid_path(world, plan.states, 1e-9));
    if (!plan.arrives()) continue;
    REQUIRE(plan.states.back() == query.goal_m);
    REQUIRE(plan.length == Approx(length_of(domain, plan.states)));
    graph.plan(query.start_m, query.goal_m);
    REQUIRE(plan.length >= graph.shortest_m() * (1 - 1e-9));
    outcome.solved += 1;
    outcome.mean_length_ratio += plan.length / graph.shortest_m();
  }
  outcome.mean_length_ratio /= outcome.solved;
  return outcome;
}

TEST_CASE("grid search finds paths only slightly longer than the shortest path") {
  const auto seed = GENERATE(1u, 2u, 3u);
  for (const std::string name : {"empty", "circles", "mixed", "maze", "u"}) {
    CAPTURE(name, seed);
    const Outcome a_star = plan_world(GridPlanner({.order = GridOrder::kAStar}), name, seed);
    const Outcome breadth = plan_world(GridPlanner({.order = GridOrder::kBreadthFirst}), name, seed);
    const Outcome depth = plan_world(GridPlanner({.order = GridOrder::kDepthFirst}), name, seed);
    CHECK(a_star.solved >= 9);
    CHECK(breadth.solved == a_star.solved);
    CHECK(depth.solved == a_star.solved);
    // Paths are at most 8.3 % longer because of the eight directions, plus the width of the cells.
    CHECK(a_star.mean_length_ratio < 1.12);
    CHECK(a_star.mean_length_ratio <= breadth.mean_length_ratio);
    CHECK(breadth.mean_length_ratio <= depth.mean_length_ratio);
  }
}

TEST_CASE("cell decompositions lead to the goal in all worlds") {
  const auto seed = GENERATE(1u, 2u, 3u);
  for (const std::string& name : world_names()) {
    CAPTURE(name, seed);
    const Outcome squares = plan_world(QuadTree(), name, seed);
    // The smallest squares are wider than the passages of the narrow worlds.
    CHECK((squares.solved >= 6 || name == "gap" || name == "trap"));
    CHECK((squares.mean_length_ratio < 1.6 || squares.solved == 0));
    const Outcome trapezoids = plan_world(TrapezoidalDecomposition(), name, seed);
    CHECK(trapezoids.solved == 10);
    CHECK(trapezoids.mean_length_ratio < 1.5);
  }
}

TEST_CASE("the trapezoids cover exactly the free positions") {
  const auto seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  const PlanWorld world = make_world("mixed", 1, seed);
  const ObstacleWorld obstacles(world.obstacles);
  Rng rng(seed);
  TrapezoidalDecomposition planner;
  // The query must have no straight path, because a straight path would skip the decomposition.
  const Vec2 start = world.queries[0].start_m, goal = world.queries[0].goal_m;
  planner.plan({obstacles, world.field, world.radius_m, start, goal}, start, {}, rng);
  PlanWorld smaller_robot = world, larger_robot = world;
  smaller_robot.radius_m -= 1e-7;
  larger_robot.radius_m += 0.01;
  for (int i = 0; i < 3'000; ++i) {
    const double y = rng.uniform(-4.89, 4.89), x = rng.uniform(-4.89, 4.89);
    const Vec2 position(x, y);
    CAPTURE(position.transpose());
    const auto contains = [&](const ConvexPolygon& cell) {
      return signed_distance(position, std::span<const Vec2>(cell.corners_m)) < -1e-9;
    };
    const auto count = std::count_if(planner.cells().cells.begin(), planner.cells().cells.end(), contains);
    if (count > 0) REQUIRE(is_free(smaller_robot, position));
    if (count == 0)
      REQUIRE_FALSE((is_free(larger_robot, position) && larger_robot.field.contains(position, 0.11)));
    REQUIRE(count <= 1);
    // Point location finds the same cell.
    const std::optional<std::uint32_t> cell = planner.cell_at(position);
    if (count == 1) REQUIRE((cell && contains(planner.cells().cells[*cell])));
    if (count == 0 && cell) {
      const std::span<const Vec2> corners = planner.cells().cells[*cell].corners_m;
      REQUIRE(signed_distance(position, corners) < 1e-7);
    }
  }
}

TEST_CASE("obstacles on or beyond the field's border do not change the trapezoids inside") {
  PlanWorld world;
  world.obstacles = {Box{{-0.5, -2}, {0.5, 2}}};
  const Vec2 start(-3, 0), goal(3, 0);
  Rng rng(1);
  TrapezoidalDecomposition planner;
  const ObstacleWorld one(world.obstacles);
  const double length_m =
      planner.plan({one, world.field, world.radius_m, start, goal}, start, {}, rng).length;
  CHECK(length_m > 6);
  world.obstacles.push_back(Circle{{1e9, 0}, 1});
  world.obstacles.push_back(Box{{-20, 6}, {20, 7}});
  world.obstacles.push_back(Segment{{-5, 20}, {5, 20}});
  const ObstacleWorld more(world.obstacles);
  const Plan<Vec2>& plan = planner.plan({more, world.field, world.radius_m, start, goal}, start, {}, rng);
  CHECK(plan.length == Approx(length_m).epsilon(1e-6));
  // This obstacle crosses the border and leaves only the way below the box.
  world.obstacles.push_back(Box{{-0.1, 1}, {0.1, 8}});
  const ObstacleWorld most(world.obstacles);
  const Plan<Vec2>& below = planner.plan({most, world.field, world.radius_m, start, goal}, start, {}, rng);
  REQUIRE(below.arrives());
  CHECK(is_valid_path(world, below.states, 1e-9));
  for (const Vec2& state : below.states) CHECK(state.y() <= 0);
}

/// Shapes with coordinates that are multiples of half a metre, so that many boundaries coincide.
PlanWorld aligned_world(Rng& rng) {
  PlanWorld world;
  world.radius_m = rng.chance(0.5) ? 0.25 : 0.5;
  const auto half_metres = [&](std::uint64_t count) { return 0.5 * static_cast<double>(rng.below(count)); };
  const std::size_t count = 3 + rng.below(30);
  while (world.obstacles.size() < count) {
    const double y = half_metres(21) - 5, x = half_metres(21) - 5;
    const double width_m = 0.5 + half_metres(4), length_m = 0.5 + half_metres(4);
    const Vec2 at(x, y);
    const Shape shapes[] = {Box{at, at + Vec2(length_m, width_m)}, Segment{at, at + Vec2(length_m, 0)},
                            Segment{at, at + Vec2(0, width_m)}, Circle{at, length_m / 2},
                            ConvexPolygon{{at, at + Vec2(length_m, 0), at + Vec2(0, length_m)}}};
    world.obstacles.push_back(shapes[rng.below(std::size(shapes))]);
  }
  return world;
}

TEST_CASE(
    "the decomposition solves every query that the visibility graph solves, even if boundaries coincide") {
  TrapezoidalDecomposition trapezoids;
  LazyVisibility visibility;
  int solved = 0, unsolvable = 0;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    Rng rng(seed);
    const PlanWorld world = aligned_world(rng);
    const ObstacleWorld obstacles(world.obstacles);
    const auto position = [&] {
      const double y = rng.uniform(-4.4, 4.4), x = rng.uniform(-4.4, 4.4);
      return Vec2(x, y);
    };
    const Vec2 start = position(), goal = position();
    if (!is_free(world, start) || !is_free(world, goal)) continue;
    CAPTURE(seed, start.transpose(), goal.transpose());
    const DiscDomain domain(obstacles, world.field, world.radius_m, start, goal);
    const Plan<Vec2>& plan = trapezoids.plan(domain, start, {}, rng);
    REQUIRE(is_valid_path(world, plan.states, 1e-9));
    REQUIRE(plan.arrives() == visibility.plan(domain, start, {}, rng).arrives());
    solved += plan.arrives();
    unsolvable += !plan.arrives();
  }
  CHECK(solved > 400);
  CHECK(unsolvable > 10);
}

TEST_CASE("grids and cell decompositions report that an enclosed goal is unreachable") {
  std::vector<Shape> ring;
  for (int i = 0; i < 24; ++i)
    ring.push_back(Circle{2 * Vec2(std::cos(i * 0.2618), std::sin(i * 0.2618)), 0.25});
  PlanWorld world;
  world.obstacles = ring;
  const ObstacleWorld obstacles(ring);
  const Vec2 start(4, 4), goal(0, 0);
  const DiscDomain domain(obstacles, world.field, world.radius_m, start, goal);
  Rng rng(1);
  GridPlanner grid;
  QuadTree squares;
  TrapezoidalDecomposition trapezoids;
  NavigationPlanner estar, nf1({.field = {.kernel = GridKernel::kNf1}});
  CHECK(estar.plan(domain, start, {}, rng).reason == PlanReason::kUnreachable);
  CHECK(nf1.plan(domain, start, {}, rng).reason == PlanReason::kUnreachable);
  CHECK(grid.plan(domain, start, {}, rng).reason == PlanReason::kUnreachable);
  CHECK(squares.plan(domain, start, {}, rng).reason == PlanReason::kUnreachable);
  CHECK(trapezoids.plan(domain, start, {}, rng).reason == PlanReason::kUnreachable);
  CHECK(grid.plan(domain, start, {.samples = 50}, rng).reason == PlanReason::kBudgetSpent);
}

}  // namespace sidestep::cells_test
