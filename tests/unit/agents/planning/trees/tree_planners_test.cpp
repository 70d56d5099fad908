// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/domain/disc_domain.hpp"
#include "agents/planning/smoothing/leader_follower.hpp"
#include "agents/planning/trees/bidirectional_errt.hpp"
#include "agents/planning/trees/errt.hpp"
#include "deploy/trial/planning/worlds.hpp"
#include "tests/catch.hpp"
#include "tests/unit/agents/planning/ball_domain.hpp"

namespace sidestep::tree_planners_test {

constexpr double kSlack_m = 1e-9;

template <typename State>
bool connects(const Plan<State>& plan, const State& start, const State& goal) {
  return plan.states.front() == start && plan.states.back() == goal;
}

/// Plans every query of every world twice, compares the two paths and checks them.
template <typename Planner, typename Settings>
void plan_all_worlds(const Settings& settings, std::uint64_t seed, double min_solved) {
  for (const std::string& name : world_names()) {
    const PlanWorld world = make_world(name, 12, seed);
    const ObstacleWorld obstacles(world.obstacles);
    Planner planner(settings), again(settings);
    Rng rng(seed), rng_again(seed);
    LeaderFollower<DiscDomain> smoother;
    std::size_t solved = 0;
    for (const PlanQuery& query : world.queries) {
      CAPTURE(name, seed, query.start_m.transpose(), query.goal_m.transpose());
      const DiscDomain domain(obstacles, world.field, world.radius_m, query.start_m, query.goal_m);
      Plan<Vec2> plan = planner.plan(domain, query.start_m, {}, rng);
      REQUIRE(plan.states == again.plan(domain, query.start_m, {}, rng_again).states);
      REQUIRE_FALSE((plan.start_blocked || plan.goal_blocked));
      REQUIRE(is_valid_path(world, plan.states, kSlack_m));
      REQUIRE(plan.length == Approx(length_of(domain, plan.states)));
      solved += plan.arrives() ? 1 : 0;
      if (!plan.arrives()) continue;
      REQUIRE(connects(plan, query.start_m, query.goal_m));
      const double raw = plan.length;
      smoother.smooth(domain, plan);
      REQUIRE(is_valid_path(world, plan.states, kSlack_m));
      REQUIRE(connects(plan, query.start_m, query.goal_m));
      REQUIRE(plan.length == Approx(length_of(domain, plan.states)));
      REQUIRE(plan.length <= raw);
    }
    CAPTURE(name, seed);
    CHECK(static_cast<double>(solved) >= min_solved * static_cast<double>(world.queries.size()));
  }
}

/// Two halves of the cube that are separated by a wall of balls, with or without a hole.
BallDomain divided_cube(bool with_hole) {
  std::vector<BallDomain::Ball> wall;
  for (int i = -5; i <= 5; ++i)
    for (int j = -5; j <= 5; ++j)
      if (!with_hole || i != 3 || j != 2) wall.push_back({{0, 0.2 * i, 0.2 * j}, 0.16});
  return {wall, {0.8, -0.8, -0.8}};
}

const BallDomain::State kCubeStart{-0.8, -0.8, 0.8};

TEST_CASE("a tree finds valid paths in all worlds, and the same seed gives the same paths") {
  const auto seed = GENERATE(1u, 2u, 3u);
  plan_all_worlds<Errt<DiscDomain>>(ErrtSettings{.cache_capacity = 0}, seed, 0.8);
}

TEST_CASE("a tree with a cache finds valid paths in all worlds, and the same seed gives the same paths") {
  const auto seed = GENERATE(1u, 2u, 3u);
  plan_all_worlds<Errt<DiscDomain>>(ErrtSettings{}, seed, 0.8);
}

TEST_CASE("two trees find valid paths in all worlds, and the same seed gives the same paths") {
  const auto seed = GENERATE(1u, 2u, 3u);
  plan_all_worlds<BidirectionalErrt<DiscDomain>>(BidirectionalErrtSettings{}, seed, 0.9);
  plan_all_worlds<BidirectionalErrt<DiscDomain>>(BidirectionalErrtSettings{.bridges = 4}, seed, 0.9);
}

TEST_CASE("tree planners solve queries in a domain that is unrelated to the floor") {
  const auto seed = GENERATE(range<std::uint64_t>(1, 6));
  CAPTURE(seed);
  const BallDomain domain = divided_cube(true);
  Rng rng(seed);
  Errt<BallDomain> one;
  BidirectionalErrt<BallDomain> two;
  for (const Plan<BallDomain::State>& plan :
       {one.plan(domain, kCubeStart, {}, rng), two.plan(domain, kCubeStart, {}, rng)}) {
    REQUIRE(plan.arrives());
    CHECK(connects(plan, kCubeStart, domain.goal(kCubeStart)));
    for (std::size_t i = 1; i < plan.states.size(); ++i)
      CHECK(domain.check(plan.states[i - 1], plan.states[i]));
  }
}

TEST_CASE("a planner that runs out of budget returns a path to the reached point nearest to the goal") {
  const auto seed = GENERATE(range<std::uint64_t>(1, 6));
  CAPTURE(seed);
  const BallDomain domain = divided_cube(false);
  const BallDomain::State goal = domain.goal(kCubeStart);
  Rng rng(seed);
  Errt<BallDomain> one;
  BidirectionalErrt<BallDomain> two;
  const Plan<BallDomain::State> plans[] = {one.plan(domain, kCubeStart, {.nodes = 300}, rng),
                                           two.plan(domain, kCubeStart, {.samples = 300}, rng)};
  CHECK(plans[0].nodes <= 300);
  CHECK(plans[1].samples <= 300);
  for (const auto& plan : plans) {
    CHECK(plan.reason == PlanReason::kBudgetSpent);
    CHECK(plan.states.front() == kCubeStart);
    CHECK(domain.distance(plan.states.back(), goal) < domain.distance(kCubeStart, goal));
    for (std::size_t i = 1; i < plan.states.size(); ++i)
      CHECK(domain.check(plan.states[i - 1], plan.states[i]));
  }
}

TEST_CASE("a planner stops at its deadline") {
  const BallDomain domain = divided_cube(false);
  Rng rng(1);
  Errt<BallDomain> planner;
  int asked = 0;
  const Budget budget{.until = time_from_ns(10), .clock = [&] { return time_from_ns(++asked); }};
  CHECK(planner.plan(domain, kCubeStart, budget, rng).reason == PlanReason::kBudgetSpent);
  CHECK(asked == 10);
}

TEST_CASE("more bridges give shorter paths") {
  const PlanWorld world = make_world("circles", 40, 5);
  const ObstacleWorld obstacles(world.obstacles);
  double length[2] = {0, 0};
  for (const std::size_t bridges : {1, 8}) {
    BidirectionalErrt<DiscDomain> planner({.cache_capacity = 0, .bridges = bridges});
    Rng rng(5);
    for (const PlanQuery& query : world.queries) {
      const DiscDomain domain(obstacles, world.field, world.radius_m, query.start_m, query.goal_m);
      const auto& plan = planner.plan(domain, query.start_m, {}, rng);
      REQUIRE(plan.arrives());
      length[bridges > 1] += plan.length;
    }
  }
  CHECK(length[1] < length[0]);
}

}  // namespace sidestep::tree_planners_test
