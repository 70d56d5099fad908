// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/domain/disc_domain.hpp"
#include "agents/planning/grids/navigation/descent.hpp"
#include "agents/planning/grids/navigation/navigation_planner.hpp"
#include "agents/planning/smoothing/leader_follower.hpp"
#include "agents/planning/trees/bidirectional_errt.hpp"
#include "agents/planning/trees/errt.hpp"
#include "agents/planning/visibility/lazy_visibility.hpp"
#include "deploy/trial/planning/worlds.hpp"
#include "tests/catch.hpp"
#include "tests/counted_allocations.hpp"

namespace sidestep::allocation_test {

/// Number of allocations for queries that the planner has planned before with the same random samples.
template <typename Planner>
std::size_t allocations_after_warm_up(Planner plan, const std::string& name) {
  const PlanWorld world = make_world(name, 10, 1);
  const ObstacleWorld obstacles(world.obstacles);
  std::size_t before = 0;
  for (int round = 0; round < 2; ++round) {
    Rng rng(1);
    before = allocation_count();
    for (const PlanQuery& query : world.queries)
      plan(DiscDomain(obstacles, world.field, world.radius_m, query.start_m, query.goal_m), query.start_m,
           rng);
  }
  return allocation_count() - before;
}

TEST_CASE("planners do not allocate memory after a warm-up") {
  const std::string name = GENERATE(from_range(world_names()));
  CAPTURE(name);
  const Budget budget{.samples = 2000};
  Errt<DiscDomain> errt({.cache_capacity = 0});
  BidirectionalErrt<DiscDomain> two({.cache_capacity = 0, .bridges = 3});
  LazyVisibility lazy;
  NavigationPlanner estar;
  LeaderFollower<DiscDomain> smoother;
  CHECK(allocations_after_warm_up(
            [&](const DiscDomain& d, const Vec2& s, Rng& rng) { errt.plan(d, s, budget, rng); }, name) == 0);
  CHECK(allocations_after_warm_up(
            [&](const DiscDomain& d, const Vec2& s, Rng& rng) { two.plan(d, s, budget, rng); }, name) == 0);
  CHECK(allocations_after_warm_up(
            [&](const DiscDomain& d, const Vec2& s, Rng& rng) { lazy.plan(d, s, budget, rng); }, name) == 0);
  CHECK(allocations_after_warm_up(
            [&](const DiscDomain& d, const Vec2& s, Rng& rng) { estar.plan(d, s, budget, rng); }, name) == 0);
  Plan<Vec2> plan;
  plan.states.reserve(1000);
  CHECK(allocations_after_warm_up(
            [&](const DiscDomain& d, const Vec2& s, Rng& rng) {
              plan = two.plan(d, s, budget, rng);
              smoother.smooth(d, plan);
            },
            name) == 0);
}

TEST_CASE("navigation functions do not allocate memory after a warm-up") {
  const CostGrid grid({.columns = 60, .rows = 50});
  const GridLayout& layout = grid.layout();
  EStar field(grid);
  std::vector<Vec2> path;
  std::size_t before = 0;
  for (int round = 0; round < 3; ++round) {
    before = allocation_count();
    field.set_goal({1.25, 2.03});
    field.propagate_until(layout.cell(40, 20));
    field.propagate();
    for (const float cost : {kBlocked, 5.0f, 1.0f}) {
      for (std::uint32_t row = 10; row < 40; ++row) field.set_cost(layout.cell(25, row), cost);
      field.propagate();
      REQUIRE(trace(field, {5.7, 2.4}, path));
    }
  }
  CHECK(allocation_count() - before == 0);
}

}  // namespace sidestep::allocation_test
