// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/fallback_goal.hpp"

#include "agents/planning/grids/navigation/navigation_planner.hpp"
#include "agents/planning/trees/bidirectional_errt.hpp"
#include "agents/planning/trees/errt.hpp"
#include "agents/planning/visibility/lazy_visibility.hpp"
#include "deploy/trial/planning/worlds.hpp"
#include "tests/catch.hpp"

namespace sidestep::fallback_goal_test {

/// Whether a path that starts in obstacles never penetrates any of them more deeply, and touches none once it
/// is out.
bool exits_obstacles_once(const PlanWorld& world, const std::vector<Vec2>& path) {
  std::vector<double> min_distance;
  for (const Shape& shape : world.obstacles)
    min_distance.push_back(std::min(signed_distance(path.front(), shape), world.radius_m));
  for (std::size_t i = 1; i < path.size(); ++i) {
    for (int k = 0; k <= 400; ++k) {
      const Vec2 position = path[i - 1] + k / 400.0 * (path[i] - path[i - 1]);
      for (std::size_t j = 0; j < world.obstacles.size(); ++j) {
        const double distance = signed_distance(position, world.obstacles[j]);
        if (distance < min_distance[j] - 1e-5) return false;
        min_distance[j] = std::max(min_distance[j], std::min(distance, world.radius_m));
      }
    }
  }
  return true;
}

/// A position that penetrates an obstacle by up to 0.3 m.
Vec2 blocked_position(const PlanWorld& world, Rng& rng) {
  for (;;) {
    const double y = rng.uniform(-4.8, 4.8), x = rng.uniform(-4.8, 4.8);
    const Vec2 position(x, y);
    double min_distance = 1;
    for (const Shape& shape : world.obstacles)
      min_distance = std::min(min_distance, signed_distance(position, shape));
    if (min_distance <= world.radius_m && min_distance > world.radius_m - 0.3) return position;
  }
}

/// The distance to the nearest free position, found on a fine grid around the position.
double distance_to_free(const PlanWorld& world, const Vec2& position) {
  double nearest = 10;
  for (double x = -1; x <= 1; x += 0.01) {
    for (double y = -1; y <= 1; y += 0.01) {
      const double distance = std::hypot(x, y);
      if (distance < nearest && is_free(world, position + Vec2(x, y))) nearest = distance;
    }
  }
  return nearest;
}

template <typename Planner>
void check_paths_out_of_obstacles(std::uint64_t seed, int min_solved) {
  for (const std::string name : {"circles", "mixed"}) {
    const PlanWorld world = make_world(name, 20, seed);
    const ObstacleWorld obstacles(world.obstacles);
    Planner planner;
    Rng rng(seed);
    int solved = 0;
    for (const PlanQuery& query : world.queries) {
      const Vec2 start = blocked_position(world, rng);
      CAPTURE(name, seed, start.transpose(), query.goal_m.transpose());
      const DiscDomain domain(obstacles, world.field, world.radius_m, start, query.goal_m);
      const Plan<Vec2> plan = plan_with_fallback_goal(planner, domain, start, {.samples = 5000}, rng);
      REQUIRE(plan.start_blocked);
      REQUIRE_FALSE(plan.goal_blocked);
      REQUIRE(plan.states.front() == start);
      REQUIRE(exits_obstacles_once(world, plan.states));
      if (!plan.arrives()) continue;
      REQUIRE(plan.states.back() == query.goal_m);
      ++solved;
    }
    CAPTURE(name, seed);
    CHECK(solved >= min_solved);
  }
}

template <typename Planner>
void check_paths_into_obstacles(std::uint64_t seed) {
  for (const std::string name : {"circles", "mixed"}) {
    const PlanWorld world = make_world(name, 20, seed);
    const ObstacleWorld obstacles(world.obstacles);
    Planner planner;
    Rng rng(seed);
    int near = 0;
    for (const PlanQuery& query : world.queries) {
      const Vec2 requested = blocked_position(world, rng);
      CAPTURE(name, seed, query.start_m.transpose(), requested.transpose());
      const DiscDomain domain(obstacles, world.field, world.radius_m, query.start_m, requested);
      const Plan<Vec2> plan = plan_with_fallback_goal(planner, domain, query.start_m, {.samples = 5000}, rng);
      REQUIRE(plan.goal_blocked);
      REQUIRE_FALSE(plan.start_blocked);
      REQUIRE(is_valid_path(world, plan.states, 1e-9));
      const double left = (plan.states.back() - requested).norm();
      if (left <= distance_to_free(world, requested) * 1.02 + 0.02) ++near;
    }
    // For the remaining goals, the nearest free position is in an unreachable pocket.
    CAPTURE(name, seed);
    CHECK(near >= 14);
  }
}

TEST_CASE("a path that starts in an obstacle leaves it without penetrating deeper") {
  const auto seed = GENERATE(1u, 2u, 3u);
  check_paths_out_of_obstacles<LazyVisibility>(seed, 16);
  check_paths_out_of_obstacles<BidirectionalErrt<DiscDomain>>(seed, 14);
  check_paths_out_of_obstacles<Errt<DiscDomain>>(seed, 14);
  check_paths_out_of_obstacles<NavigationPlanner>(seed, 14);
}

TEST_CASE("a path to a goal in an obstacle ends as near to the goal as possible") {
  const auto seed = GENERATE(1u, 2u, 3u);
  check_paths_into_obstacles<LazyVisibility>(seed);
  check_paths_into_obstacles<BidirectionalErrt<DiscDomain>>(seed);
  check_paths_into_obstacles<NavigationPlanner>(seed);
}

TEST_CASE("a goal in an obstacle is replaced by the nearest reachable free position") {
  // A box with a pocket. The free position nearest to the goal is inside the pocket.
  //  +-----+
  //  |g   .|   g: the requested goal, in the left wall but nearer to the inside
  //  +-----+
  PlanWorld world;
  world.obstacles = {Box{{-1.5, -1}, {-0.9, 1}}, Box{{0.9, -1}, {1, 1}}, Box{{-1.5, 0.9}, {1, 1}},
                     Box{{-1.5, -1}, {1, -0.9}}};
  const ObstacleWorld obstacles(world.obstacles);
  const Vec2 start(4, 0), requested(-1.0, 0);
  const DiscDomain domain(obstacles, world.field, world.radius_m, start, requested);
  REQUIRE(domain.goal(start).x() > -1);
  LazyVisibility planner;
  Rng rng(1);
  NavigationPlanner descent;
  for (const Plan<Vec2>& plan : {plan_with_fallback_goal(planner, domain, start, {}, rng),
                                 plan_with_fallback_goal(descent, domain, start, {}, rng)}) {
    CHECK(plan.arrives());
    CHECK(plan.goal_blocked);
    CHECK(is_valid_path(world, plan.states, 1e-9));
    CHECK((plan.states.back() - Vec2(-1.6, 0)).norm() < 0.02);
  }
}

TEST_CASE("a start without a way out is reported as blocked") {
  PlanWorld world;
  world.obstacles = {Box{{-1, -1}, {1, 1}},      Box{{-1.2, -1}, {0.9, 1}}, Segment{{-5, 0}, {5, 0.1}},
                     Segment{{0, -5}, {0.1, 5}}, Segment{{-5, -5}, {5, 5}}, Segment{{-5, 5}, {5, -5}}};
  const ObstacleWorld obstacles(world.obstacles);
  const Vec2 start(0.02, 0.05), goal(4, 2);
  const DiscDomain domain(obstacles, world.field, world.radius_m, start, goal);
  LazyVisibility lazy;
  BidirectionalErrt<DiscDomain> trees;
  NavigationPlanner descent;
  Rng rng(1);
  for (const Plan<Vec2>& plan :
       {lazy.plan(domain, start, {}, rng), trees.plan(domain, start, {.samples = 500}, rng),
        descent.plan(domain, start, {}, rng)}) {
    CHECK_FALSE(plan.arrives());
    CHECK(plan.start_blocked);
    CHECK(exits_obstacles_once(world, plan.states));
  }
}

}  // namespace sidestep::fallback_goal_test
