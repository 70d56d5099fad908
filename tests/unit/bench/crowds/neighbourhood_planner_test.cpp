// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/neighbourhood_planner.hpp"

#include <algorithm>

#include "agents/planning/joint/leg.hpp"
#include "common/motion/validity.hpp"
#include "tests/catch.hpp"
#include "tests/study/joint_planning/joint_check.hpp"
#include "tests/unit/agents/planning/joint/random_course.hpp"

namespace sidestep::neighbourhood_planner_test {

/// Enough for a few robots, and fast.
NeighbourhoodSettings quick() {
  NeighbourhoodSettings settings;
  settings.orders = 2;
  settings.states = 10'000;
  settings.beam = {.width = 80, .varied = 40, .stops = 8};
  return settings;
}

/// Free positions that are at least 0.3 m apart from each other.
std::vector<Vec2> places(Rng& rng, const ObstacleWorld& world, std::size_t count) {
  std::vector<Vec2> result;
  while (result.size() < count) {
    const Vec2 place = random_position(rng, 1.3);
    const bool is_apart =
        std::ranges::all_of(result, [&](const Vec2& other) { return (place - other).norm() > 0.3; });
    if (is_apart && !world.touches(place, 0.15)) result.push_back(place);
  }
  return result;
}

double straight_s(const JointProblem& problem, std::size_t robot) {
  const double distance_m = (problem.goals_m[robot] - problem.starts_m[robot]).norm();
  return to_seconds(leg_times(distance_m, problem.limits).total());
}

double arrival_s(const JointPlan& plan, std::size_t robot) {
  return to_seconds(plan.courses[robot].end() - Time{});
}

TEST_CASE("plans at full speed have no fault, and no robot is faster than the straight line") {
  double ratio = 0;
  int robots = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    std::vector<Shape> obstacles{Circle{{0, 0}, 0.2}, Box{{-0.9, 0.3}, {-0.6, 0.4}}};
    const ObstacleWorld world(obstacles);
    JointProblem problem;
    problem.world = &world;
    problem.field = {3, 3};
    const std::size_t count = 1 + rng.below(8);
    problem.starts_m = places(rng, world, count);
    problem.goals_m = places(rng, world, count);
    Rng first(seed), second(seed);
    const JointPlan plan = NeighbourhoodPlanner(quick()).plan(problem, {}, first);
    REQUIRE(plan.arrives());
    CHECK(fault_of(problem, obstacles, plan.courses) == "");
    for (std::size_t i = 0; i < count; ++i) {
      CHECK(arrival_s(plan, i) >= straight_s(problem, i) - 1e-6);
      ratio += arrival_s(plan, i) / straight_s(problem, i);
      ++robots;
      for (const Trajectory& leg : plan.courses[i].legs()) {
        const Validity validity = check_limits(leg, problem.limits);
        CHECK((validity == Validity::kValid || validity == Validity::kNotAtRest));
      }
    }
    const JointPlan again = NeighbourhoodPlanner(quick()).plan(problem, {}, second);
    CHECK(again.makespan_s() == plan.makespan_s());
  }
  CHECK(ratio / robots < 1.1);
}

TEST_CASE("a robot with a free way drives straight to its goal") {
  const ObstacleWorld world;
  JointProblem problem;
  problem.world = &world;
  problem.field = {4, 2};
  problem.starts_m = {{-1.5, 0.5}, {1.5, -0.5}};
  problem.goals_m = {{1.5, 0.5}, {-1.5, -0.5}};
  Rng rng(1);
  const JointPlan plan = NeighbourhoodPlanner(quick()).plan(problem, {}, rng);
  REQUIRE(plan.arrives());
  for (std::size_t i = 0; i < 2; ++i)
    CHECK(arrival_s(plan, i) == Approx(straight_s(problem, i)).margin(1e-6));
}

TEST_CASE("robots that meet in a door for one pass it one after another") {
  std::vector<Shape> obstacles{Box{{-0.05, -1}, {0.05, -0.16}}, Box{{-0.05, 0.16}, {0.05, 1}}};
  const ObstacleWorld world(obstacles);
  JointProblem problem;
  problem.world = &world;
  problem.field = {4, 2};
  problem.starts_m = {{-0.8, 0}, {0.8, 0.05}, {-0.8, 0.5}, {0.8, -0.5}};
  problem.goals_m = {{0.8, 0.5}, {-0.8, -0.5}, {0.8, 0.05}, {-0.8, 0}};
  Rng rng(1);
  const JointPlan plan = NeighbourhoodPlanner(quick()).plan(problem, {}, rng);
  REQUIRE(plan.arrives());
  CHECK(fault_of(problem, obstacles, plan.courses) == "");
  CHECK(plan.makespan_s() < 3);
}

TEST_CASE("a robot at its goal lets another one pass and returns") {
  // A resting robot blocks a corridor; there is room beside its exit.
  std::vector<Shape> obstacles{Box{{-2, 0.15}, {0.2, 1}}, Box{{-2, -1}, {0.2, -0.15}}};
  const ObstacleWorld world(obstacles);
  JointProblem problem;
  problem.world = &world;
  problem.field = {4, 2};
  problem.starts_m = {{0.1, 0}, {-1.5, 0}};
  problem.goals_m = {{0.1, 0}, {1.5, 0}};
  Rng rng(3);
  const JointPlan plan = NeighbourhoodPlanner(quick()).plan(problem, {}, rng);
  REQUIRE(plan.arrives());
  CHECK(fault_of(problem, obstacles, plan.courses) == "");
  CHECK(arrival_s(plan, 0) > 0.5);
}

TEST_CASE("robots obey their own speed limits") {
  const ObstacleWorld world;
  JointProblem problem;
  problem.world = &world;
  problem.field = {4, 2};
  problem.starts_m = {{-1.5, 0}, {1.5, 0}};
  problem.goals_m = {{1.5, 0}, {-1.5, 0}};
  const std::vector<double> limits_mps{0.5, 3};
  Rng rng(1);
  const JointPlan plan = NeighbourhoodPlanner(quick()).plan(problem, limits_mps, rng);
  REQUIRE(plan.arrives());
  for (const Trajectory& leg : plan.courses[0].legs())
    for (Time t = leg.start(); t < leg.end(); t += from_seconds(0.02))
      REQUIRE(leg.state_at(t).velocity_mps.norm() <= 0.5 + 1e-6);
  CHECK(fault_of(problem, {}, plan.courses) == "");
  CHECK(arrival_s(plan, 1) < 1.2 * straight_s(problem, 1));
}

TEST_CASE("the planner at full speed refuses invalid problems and settings") {
  const ObstacleWorld world({Circle{{0, 0}, 0.3}});
  JointProblem problem;
  NeighbourhoodPlanner planner(quick());
  Rng rng(1);
  CHECK_THROWS_AS(planner.plan(problem, {}, rng), std::invalid_argument);
  problem.world = &world;
  problem.starts_m = {{1, 0}, {1, 1}};
  problem.goals_m = {{-1, 0}, {-1, 0.1}};
  CHECK(planner.plan(problem, {}, rng).reason == PlanReason::kUnreachable);
  problem.goals_m = {{-1, 0}, {0, 0.35}};
  CHECK(planner.plan(problem, {}, rng).reason == PlanReason::kUnreachable);
  problem.goals_m = {{-1, 0}, {-1, 1}};
  CHECK(planner.plan(problem, {}, rng).arrives());
  const std::vector<double> one_limit_mps{1}, no_motion_mps{1, 0};
  CHECK_THROWS_AS(planner.plan(problem, one_limit_mps, rng), std::invalid_argument);
  CHECK_THROWS_AS(planner.plan(problem, no_motion_mps, rng), std::invalid_argument);
  NeighbourhoodSettings settings;
  settings.replanned = 1;
  CHECK_THROWS_AS(NeighbourhoodPlanner(settings), std::invalid_argument);
  settings = {};
  settings.beam.width = 0;
  CHECK_THROWS_AS(NeighbourhoodPlanner(settings), std::invalid_argument);
}

}  // namespace sidestep::neighbourhood_planner_test
