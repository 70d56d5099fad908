// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/neighbourhood_planner.hpp"

#include "agents/planning/joint/leg.hpp"
#include "common/motion/validity.hpp"
#include "tests/catch.hpp"
#include "tests/study/joint_planning/joint_check.hpp"
#include "tests/unit/agents/planning/joint/joint_floor.hpp"

namespace sidestep::neighbourhood_planner_test {

/// Enough for a few robots, and fast.
NeighbourhoodSettings quick() {
  NeighbourhoodSettings settings;
  settings.orders = 2;
  settings.states = 10'000;
  settings.beam = {.width = 80, .varied = 40, .stops = 8};
  return settings;
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
    JointFloor floor({3, 3}, {Circle{{0, 0}, 0.2}, Box{{-0.9, 0.3}, {-0.6, 0.4}}});
    const JointProblem& problem = floor.problem;
    const std::size_t count = 1 + rng.below(8);
    floor.place_robots(count, rng);
    Rng first(seed), second(seed);
    const JointPlan plan = NeighbourhoodPlanner(quick()).plan(problem, {}, first);
    REQUIRE(plan.arrives());
    CHECK(fault_of(problem, floor.obstacles, plan.courses) == "");
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
  JointFloor floor({4, 2}, {});
  JointProblem& problem = floor.problem;
  problem.starts_m = {{-1.5, 0.5}, {1.5, -0.5}};
  problem.goals_m = {{1.5, 0.5}, {-1.5, -0.5}};
  Rng rng(1);
  const JointPlan plan = NeighbourhoodPlanner(quick()).plan(problem, {}, rng);
  REQUIRE(plan.arrives());
  for (std::size_t i = 0; i < 2; ++i)
    CHECK(arrival_s(plan, i) == Approx(straight_s(problem, i)).margin(1e-6));
}

TEST_CASE("robots that meet in a door for one pass it one after another") {
  JointFloor floor({4, 2}, {Box{{-0.05, -1}, {0.05, -0.16}}, Box{{-0.05, 0.16}, {0.05, 1}}});
  JointProblem& problem = floor.problem;
  problem.starts_m = {{-0.8, 0}, {0.8, 0.05}, {-0.8, 0.5}, {0.8, -0.5}};
  problem.goals_m = {{0.8, 0.5}, {-0.8, -0.5}, {0.8, 0.05}, {-0.8, 0}};
  Rng rng(1);
  const JointPlan plan = NeighbourhoodPlanner(quick()).plan(problem, {}, rng);
  REQUIRE(plan.arrives());
  CHECK(fault_of(problem, floor.obstacles, plan.courses) == "");
  CHECK(plan.makespan_s() < 3);
}

TEST_CASE("a robot at its goal lets another one pass and returns") {
  // A resting robot blocks a corridor; there is room beside its exit.
  JointFloor floor({4, 2}, {Box{{-2, 0.15}, {0.2, 1}}, Box{{-2, -1}, {0.2, -0.15}}});
  JointProblem& problem = floor.problem;
  problem.starts_m = {{0.1, 0}, {-1.5, 0}};
  problem.goals_m = {{0.1, 0}, {1.5, 0}};
  Rng rng(3);
  const JointPlan plan = NeighbourhoodPlanner(quick()).plan(problem, {}, rng);
  REQUIRE(plan.arrives());
  CHECK(fault_of(problem, floor.obstacles, plan.courses) == "");
  CHECK(arrival_s(plan, 0) > 0.5);
}

TEST_CASE("robots obey their own speed limits") {
  JointFloor floor({4, 2}, {});
  JointProblem& problem = floor.problem;
  problem.starts_m = {{-1.5, 0}, {1.5, 0}};
  problem.goals_m = {{1.5, 0}, {-1.5, 0}};
  const std::vector<double> limits_mps{0.5, 3};
  Rng rng(1);
  const JointPlan plan = NeighbourhoodPlanner(quick()).plan(problem, limits_mps, rng);
  REQUIRE(plan.arrives());
  for (const Trajectory& leg : plan.courses[0].legs())
    for (Time t = leg.start(); t < leg.end(); t += from_seconds(0.02))
      REQUIRE(leg.state_at(t).velocity_mps.norm() <= 0.5 + 1e-6);
  CHECK(fault_of(problem, {}, plan.courses, limits_mps) == "");
  CHECK(arrival_s(plan, 1) < 1.2 * straight_s(problem, 1));
}

TEST_CASE("the planner at full speed refuses invalid problems and settings") {
  NeighbourhoodPlanner planner(quick());
  Rng rng(1);
  check_refusals([&](const JointProblem& problem) { return planner.plan(problem, {}, rng); });
  JointFloor floor({}, {});
  floor.problem.starts_m = {{1, 0}, {1, 1}};
  floor.problem.goals_m = {{-1, 0}, {-1, 1}};
  const std::vector<double> one_limit_mps{1}, no_motion_mps{1, 0};
  CHECK_THROWS_AS(planner.plan(floor.problem, one_limit_mps, rng), std::invalid_argument);
  CHECK_THROWS_AS(planner.plan(floor.problem, no_motion_mps, rng), std::invalid_argument);
  NeighbourhoodSettings settings;
  settings.replanned = 1;
  CHECK_THROWS_AS(NeighbourhoodPlanner(settings), std::invalid_argument);
  settings = {};
  settings.beam.width = 0;
  CHECK_THROWS_AS(NeighbourhoodPlanner(settings), std::invalid_argument);
}

}  // namespace sidestep::neighbourhood_planner_test
