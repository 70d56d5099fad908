// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "agents/planning/joint/joint_plan.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/collision/random_world.hpp"

namespace sidestep {

/// A joint planning problem with its obstacles.
struct JointFloor {
  JointFloor(const Field& field, std::vector<Shape> shapes) : obstacles(std::move(shapes)), world(obstacles) {
    problem.world = &world;
    problem.field = field;
  }
  JointFloor(const JointFloor&) = delete;
  JointFloor& operator=(const JointFloor&) = delete;

  /// Draws starts and goals of robots from a square of 2.6 m. They are apart from each other and obstacles.
  void place_robots(std::size_t count, Rng& rng) {
    problem.starts_m = random_places(count, rng);
    problem.goals_m = random_places(count, rng);
  }

  std::vector<Shape> obstacles;
  ObstacleWorld world;
  JointProblem problem;

 private:
  std::vector<Vec2> random_places(std::size_t count, Rng& rng) const {
    std::vector<Vec2> places_m;
    while (places_m.size() < count) {
      const Vec2 place_m = random_position(rng, 1.3);
      const bool is_apart = std::ranges::all_of(
          places_m, [&](const Vec2& other_m) { return (place_m - other_m).norm() > 0.3; });
      if (is_apart && !world.touches(place_m, 0.15)) places_m.push_back(place_m);
    }
    return places_m;
  }
};

/// Checks that a planner refuses invalid problems and reports goals that robots cannot share. `plan` is
/// called with a JointProblem and returns a JointPlan.
template <typename Plan>
void check_refusals(Plan plan) {
  JointFloor floor({}, {Circle{{0, 0}, 0.3}});
  JointProblem& problem = floor.problem;
  CHECK_THROWS_AS(plan(JointProblem{}), std::invalid_argument);
  CHECK_THROWS_AS(plan(problem), std::invalid_argument);
  problem.starts_m = {{1, 0}, {1, 1}};
  problem.goals_m = {{-1, 0}};
  CHECK_THROWS_AS(plan(problem), std::invalid_argument);
  problem.goals_m = {{-1, 0}, {-1, 0.1}};
  CHECK(plan(problem).reason == PlanReason::kUnreachable);
  problem.goals_m = {{-1, 0}, {0, 0.35}};
  CHECK(plan(problem).reason == PlanReason::kUnreachable);
  problem.goals_m = {{-1, 0}, {-1, 1}};
  CHECK(plan(problem).arrives());
}

}  // namespace sidestep
