// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/joint/composite_planner.hpp"
#include "agents/planning/joint/prioritised_planner.hpp"
#include "common/motion/validity.hpp"
#include "tests/catch.hpp"
#include "tests/study/joint_planning/joint_check.hpp"
#include "tests/unit/agents/planning/joint/joint_floor.hpp"

namespace sidestep::joint_planners_test {

const Budget kBudget{20'000, 20'000};

template <typename Planner>
void check_on_random_floors() {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    std::vector<Shape> obstacles;
    for (int i = 0; i < 4; ++i) {
      const Vec2 at = random_position(rng, 1.2);
      if (i % 2)
        obstacles.emplace_back(Circle{at, 0.15});
      else
        obstacles.emplace_back(Box{at, at + Vec2(0.3, 0.1)});
    }
    JointFloor floor({3, 3}, obstacles);
    const JointProblem& problem = floor.problem;
    floor.place_robots(1 + rng.below(5), rng);
    Planner planner, again;
    Rng first(seed), second(seed);
    const JointPlan plan = planner.plan(problem, kBudget, first);
    REQUIRE(plan.arrives());
    CHECK(fault_of(problem, obstacles, plan.courses) == "");
    // Each trajectory must satisfy the rules that the coordinator checks.
    const FloorRules rules{problem.field, obstacles, problem.limits, problem.radius_m, problem.margin_m};
    for (const Course& course : plan.courses)
      for (const Trajectory& leg : course.legs()) {
        CHECK(check_limits(leg, problem.limits) == Validity::kValid);
        CHECK(check_workspace(leg, rules) == Validity::kValid);
      }
    CHECK(again.plan(problem, kBudget, second).makespan_s() == plan.makespan_s());
  }
}

TEST_CASE("the composite planner solves random floors, and an independent check finds no fault") {
  check_on_random_floors<CompositePlanner>();
}

TEST_CASE("the prioritised planner solves random floors, and an independent check finds no fault") {
  check_on_random_floors<PrioritisedPlanner>();
}

//  +-----------------+
//  | A             B |   A and B change places; only the bay lets them pass.
//  +-------+  +------+
//          +--+
struct BayFloor : JointFloor {
  BayFloor() : JointFloor({3, 0.9}, {Box{{-1.5, -0.45}, {-0.2, 0.15}}, Box{{0.2, -0.45}, {1.5, 0.15}}}) {
    problem.starts_m = {{-1.2, 0.3}, {1.2, 0.3}};
    problem.goals_m = {{1.2, 0.3}, {-1.2, 0.3}};
  }
};

TEST_CASE("robots in a corridor use its bay to pass each other") {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    CAPTURE(seed);
    const BayFloor floor;
    Rng rng(seed);
    const JointPlan plan = CompositePlanner().plan(floor.problem, kBudget, rng);
    REQUIRE(plan.arrives());
    CHECK(fault_of(floor.problem, floor.obstacles, plan.courses) == "");
  }
}

TEST_CASE("prioritised planning fails if the first robot's path leaves no room for the second") {
  // The robots drive as fast as they can, so the first one is past the bay before the other one is inside.
  const BayFloor floor;
  Rng rng(1);
  const JointPlan plan = PrioritisedPlanner().plan(floor.problem, kBudget, rng);
  CHECK(plan.reason == PlanReason::kBudgetSpent);
  CHECK(plan.courses.empty());
}

template <typename Planner>
void check_planner_refusals() {
  Rng rng(1);
  Planner planner;
  check_refusals([&](const JointProblem& problem) { return planner.plan(problem, kBudget, rng); });
  JointFloor floor({}, {Circle{{0, 0}, 0.3}});
  floor.problem.starts_m = {{1, 0}, {1, 1}};
  floor.problem.goals_m = {{-1, 0}, {-1, 1}};
  CHECK(Planner().plan(floor.problem, Budget{.samples = 0}, rng).reason == PlanReason::kBudgetSpent);
}

TEST_CASE("joint planners refuse invalid problems, and give up if they have no budget") {
  check_planner_refusals<CompositePlanner>();
  check_planner_refusals<PrioritisedPlanner>();
}

}  // namespace sidestep::joint_planners_test
