// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/robust.hpp"

#include <catch2/catch.hpp>

#include "agents/planning/trees/bidirectional_errt.hpp"
#include "agents/planning/trees/errt.hpp"
#include "agents/planning/visibility/lazy_visibility.hpp"
#include "deploy/evaluation/planning/worlds.hpp"

using namespace sidestep;

namespace {

/// Whether a way that begins in obstacles comes no nearer to any of them until it is out, and then touches
/// nothing any more.
bool leaves_and_stays_out(const PlanWorld& world, const std::vector<Vec2>& way) {
  std::vector<double> least;
  for (const Shape& shape : world.obstacles)
    least.push_back(std::min(signed_distance(way.front(), shape), world.radius_m));
  for (std::size_t i = 1; i < way.size(); ++i) {
    for (int k = 0; k <= 400; ++k) {
      const Vec2 place = way[i - 1] + k / 400.0 * (way[i] - way[i - 1]);
      for (std::size_t j = 0; j < world.obstacles.size(); ++j) {
        const double distance = signed_distance(place, world.obstacles[j]);
        if (distance < least[j] - 1e-5) return false;
        least[j] = std::max(least[j], std::min(distance, world.radius_m));
      }
    }
  }
  return true;
}

/// A place that touches an obstacle, by up to 0.3 m.
Vec2 blocked_place(const PlanWorld& world, Rng& rng) {
  for (;;) {
    const Vec2 place(rng.uniform(-4.8, 4.8), rng.uniform(-4.8, 4.8));
    double least = 1;
    for (const Shape& shape : world.obstacles) least = std::min(least, signed_distance(place, shape));
    if (least <= world.radius_m && least > world.radius_m - 0.3) return place;
  }
}

/// The distance to the nearest free place, by a fine grid round the place.
double distance_to_free(const PlanWorld& world, const Vec2& place) {
  double nearest = 10;
  for (double x = -1; x <= 1; x += 0.01) {
    for (double y = -1; y <= 1; y += 0.01) {
      const double distance = std::hypot(x, y);
      if (distance < nearest && is_free(world, place + Vec2(x, y))) nearest = distance;
    }
  }
  return nearest;
}

template <typename Planner>
void leave_obstacles(std::uint64_t seed, int least_solved) {
  for (const std::string name : {"circles", "mixed"}) {
    const PlanWorld world = make_world(name, 20, seed);
    const ObstacleWorld obstacles(world.obstacles);
    Planner planner;
    Rng rng(seed);
    int solved = 0;
    for (const PlanQuery& query : world.queries) {
      const Vec2 start = blocked_place(world, rng);
      CAPTURE(name, seed, start.transpose(), query.goal_m.transpose());
      const DiscDomain domain(obstacles, world.field, world.radius_m, start, query.goal_m);
      const Plan<Vec2>& plan = plan_robustly(planner, domain, start, {.samples = 5000}, rng);
      REQUIRE(plan.start_blocked);
      REQUIRE_FALSE(plan.goal_blocked);
      REQUIRE(plan.states.front() == start);
      REQUIRE(leaves_and_stays_out(world, plan.states));
      if (!plan.arrives()) continue;
      REQUIRE(plan.states.back() == query.goal_m);
      ++solved;
    }
    CAPTURE(name, seed);
    CHECK(solved >= least_solved);
  }
}

template <typename Planner>
void approach_obstacles(std::uint64_t seed) {
  for (const std::string name : {"circles", "mixed"}) {
    const PlanWorld world = make_world(name, 20, seed);
    const ObstacleWorld obstacles(world.obstacles);
    Planner planner;
    Rng rng(seed);
    int near = 0;
    for (const PlanQuery& query : world.queries) {
      const Vec2 wanted = blocked_place(world, rng);
      CAPTURE(name, seed, query.start_m.transpose(), wanted.transpose());
      const DiscDomain domain(obstacles, world.field, world.radius_m, query.start_m, wanted);
      const Plan<Vec2>& plan = plan_robustly(planner, domain, query.start_m, {.samples = 5000}, rng);
      REQUIRE(plan.goal_blocked);
      REQUIRE_FALSE(plan.start_blocked);
      REQUIRE(is_valid_way(world, plan.states, 0.003, 1e-9));
      const double left = (plan.states.back() - wanted).norm();
      if (left <= distance_to_free(world, wanted) * 1.02 + 0.02) ++near;
    }
    // The others are nearest to a place in a pocket that nobody reaches.
    CAPTURE(name, seed);
    CHECK(near >= 14);
  }
}

}  // namespace

TEST_CASE("a start in an obstacle is left without going deeper") {
  const auto seed = GENERATE(1u, 2u, 3u);
  leave_obstacles<LazyVisibility>(seed, 16);
  leave_obstacles<BidirectionalErrt<DiscDomain>>(seed, 14);
  leave_obstacles<Errt<DiscDomain>>(seed, 14);
}

TEST_CASE("a goal in an obstacle is approached as near as can be") {
  const auto seed = GENERATE(1u, 2u, 3u);
  approach_obstacles<LazyVisibility>(seed);
  approach_obstacles<BidirectionalErrt<DiscDomain>>(seed);
}

TEST_CASE("the nearest free place that can be reached stands in for a goal in an obstacle") {
  // A box with a pocket inside: the place nearest to the goal is in there.
  //  +-----+
  //  |g   .|   g: wanted, in the left wall, nearer to the inside
  //  +-----+
  PlanWorld world;
  world.obstacles = {Box{{-1.5, -1}, {-0.9, 1}}, Box{{0.9, -1}, {1, 1}}, Box{{-1.5, 0.9}, {1, 1}},
                     Box{{-1.5, -1}, {1, -0.9}}};
  const ObstacleWorld obstacles(world.obstacles);
  const Vec2 start(4, 0), wanted(-1.0, 0);
  const DiscDomain domain(obstacles, world.field, world.radius_m, start, wanted);
  REQUIRE(domain.goal(start).x() > -1);
  LazyVisibility planner;
  Rng rng(1);
  const Plan<Vec2>& plan = plan_robustly(planner, domain, start, {}, rng);
  CHECK(plan.arrives());
  CHECK(plan.goal_blocked);
  CHECK(is_valid_way(world, plan.states, 0.003, 1e-9));
  CHECK((plan.states.back() - Vec2(-1.6, 0)).norm() < 0.02);
}

TEST_CASE("a start that cannot be left is reported") {
  PlanWorld world;
  world.obstacles = {Box{{-1, -1}, {1, 1}},      Box{{-1.2, -1}, {0.9, 1}}, Segment{{-5, 0}, {5, 0.1}},
                     Segment{{0, -5}, {0.1, 5}}, Segment{{-5, -5}, {5, 5}}, Segment{{-5, 5}, {5, -5}}};
  const ObstacleWorld obstacles(world.obstacles);
  const Vec2 start(0.02, 0.05), goal(4, 2);
  const DiscDomain domain(obstacles, world.field, world.radius_m, start, goal);
  LazyVisibility lazy;
  BidirectionalErrt<DiscDomain> trees;
  Rng rng(1);
  for (const Plan<Vec2>& plan :
       {lazy.plan(domain, start, {}, rng), trees.plan(domain, start, {.samples = 500}, rng)}) {
    CHECK_FALSE(plan.arrives());
    CHECK(plan.start_blocked);
    CHECK(leaves_and_stays_out(world, plan.states));
  }
}
