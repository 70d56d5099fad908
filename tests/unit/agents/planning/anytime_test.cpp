// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/anytime.hpp"

#include "agents/planning/trees/bidirectional_errt.hpp"
#include "agents/planning/visibility/tangent_graph.hpp"
#include "deploy/trial/planning/worlds.hpp"
#include "tests/catch.hpp"

namespace sidestep::anytime_test {

using Trees = BidirectionalErrt<DiscDomain>;
using AnytimeTrees = Anytime<DiscDomain, Trees>;
const BidirectionalErrtSettings kNoCache{.cache_capacity = 0};

TEST_CASE("paths planned with a larger budget are shorter, and nearly as short as the shortest path") {
  const auto seed = GENERATE(1u, 2u, 3u);
  const PlanWorld world = make_world("circles", 20, seed);
  const ObstacleWorld obstacles(world.obstacles);
  TangentGraph graph(obstacles, world.field, world.radius_m);
  AnytimeTrees planner{Trees(kNoCache)};
  double over[2] = {0, 0};
  for (const PlanQuery& query : world.queries) {
    CAPTURE(seed, query.start_m.transpose(), query.goal_m.transpose());
    const DiscDomain domain(obstacles, world.field, world.radius_m, query.start_m, query.goal_m);
    graph.plan(query.start_m, query.goal_m);
    for (const bool is_long : {false, true}) {
      Rng rng(seed);
      const Budget budget{.samples = is_long ? 20'000u : 4'000u};
      const Plan<Vec2>& plan = planner.plan(domain, query.start_m, budget, rng);
      REQUIRE(plan.arrives());
      REQUIRE(plan.samples <= budget.samples);
      REQUIRE(is_valid_path(world, plan.states, 1e-9));
      REQUIRE(plan.length == Approx(length_of(domain, plan.states)));
      REQUIRE(plan.length >= graph.shortest_m() * (1 - 1e-9));
      over[is_long] += plan.length / graph.shortest_m() / 20;
    }
  }
  CHECK(over[1] < over[0]);
  CHECK(over[1] < 1.06);
}

TEST_CASE("an improved path is reported as improved, and a straight path is not replanned") {
  const PlanWorld world = make_world("u", 1, 1);
  const ObstacleWorld obstacles(world.obstacles), nothing;
  const Vec2 start = world.queries[0].start_m, goal = world.queries[0].goal_m;
  Rng rng(1);
  AnytimeTrees planner{Trees(kNoCache)};
  CHECK(planner.plan({obstacles, world.field, world.radius_m, start, goal}, start, {.samples = 5000}, rng)
            .reason == PlanReason::kImproved);
  const Plan<Vec2>& straight =
      planner.plan({nothing, world.field, world.radius_m, start, goal}, start, {.samples = 5000}, rng);
  CHECK(straight.reason == PlanReason::kSolved);
  CHECK(straight.samples == 0);
}

TEST_CASE("planning ends at the deadline") {
  const PlanWorld world = make_world("u", 1, 1);
  const ObstacleWorld obstacles(world.obstacles);
  const Vec2 start = world.queries[0].start_m, goal = world.queries[0].goal_m;
  AnytimeTrees planner{Trees(kNoCache)};
  Rng rng(1);
  std::int64_t now = 0;
  const Budget budget{
      .samples = 1'000'000, .until = time_from_ns(500), .clock = [&] { return time_from_ns(++now); }};
  CHECK(planner.plan({obstacles, world.field, world.radius_m, start, goal}, start, budget, rng).arrives());
  CHECK(now >= 500);
  CHECK(now < 520);
}

}  // namespace sidestep::anytime_test
