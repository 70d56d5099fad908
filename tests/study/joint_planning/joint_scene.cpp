// SPDX-License-Identifier: Apache-2.0
#include "tests/study/joint_planning/joint_scene.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "agents/planning/joint/leg.hpp"

namespace sidestep {
namespace {

constexpr double kSide_m = 2.3, kPlaceSpacing_m = 0.45;
constexpr int kCircles = 6;
constexpr double kJointTimeLimit_s = 60;

std::vector<int> shuffled_slots(int count, Rng& rng) {
  std::vector<int> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), 0);
  rng.shuffle(numbers);
  return numbers;
}

void add_robot(Scenario& scenario, const Vec2& start_m, const Vec2& goal_m) {
  RobotSpec robot;
  robot.id = static_cast<RobotId>(scenario.robots.size());
  robot.team = goal_m.x() > start_m.x() ? Team::kBlue : Team::kYellow;
  robot.start_m = start_m;
  robot.goals.push_back({goal_m});
  scenario.robots.push_back(std::move(robot));
}

void fill_swap(Scenario& scenario, int robots, Rng& rng) {
  for (int i = 0; i < kCircles; ++i) {
    const double y = rng.uniform(-1.9, 1.9), x = rng.uniform(-1.5, 1.5), radius_m = rng.uniform(0.1, 0.3);
    scenario.obstacles.emplace_back(Circle{{x, y}, radius_m});
  }
  const int rows = robots / 2;
  for (const double side : {-1.0, 1.0}) {
    const std::vector<int> goals = shuffled_slots(rows, rng);
    for (int row = 0; row < rows; ++row) {
      const auto y = [&](int slot) { return kPlaceSpacing_m * (slot - 0.5 * (rows - 1)); };
      add_robot(scenario, {side * kSide_m, y(row)},
                {-side * kSide_m, y(goals[static_cast<std::size_t>(row)])});
    }
  }
}

void fill_circle(Scenario& scenario, int robots, Rng& rng) {
  const double radius_m = std::max(1.0, robots * kPlaceSpacing_m / (2 * std::numbers::pi));
  const double turn_rad = rng.uniform(0, 2 * std::numbers::pi);
  std::vector<Vec2> places;
  for (int i = 0; i < robots; ++i) {
    const double r = radius_m + rng.uniform(-0.05, 0.05);
    places.push_back(rotated(Vec2(r, 0), turn_rad + 2 * std::numbers::pi * i / robots));
  }
  const auto count = places.size();
  for (std::size_t i = 0; i < count; ++i) add_robot(scenario, places[i], places[(i + count / 2) % count]);
}

}  // namespace

const char* name_of(JointScene scene) { return scene == JointScene::kSwap ? "swap" : "circle"; }

Scenario joint_scene(JointScene scene, int robots, std::uint64_t seed) {
  if (robots < 2 || robots % 2 != 0 || robots > 18)
    throw std::invalid_argument("a joint scene needs an even number of robots, 2 to 18");
  Rng rng(seed);
  Scenario scenario;
  scenario.name = name_of(scene);
  scenario.field = {6, 4.5};
  scenario.time_limit_s = kJointTimeLimit_s;
  scene == JointScene::kSwap ? fill_swap(scenario, robots, rng) : fill_circle(scenario, robots, rng);
  return scenario;
}

JointProblem joint_problem(const Scenario& scenario, const ObstacleWorld& world) {
  JointProblem problem{&world, scenario.field, scenario.radius_m, scenario.margin_m, scenario.limits, {}, {}};
  for (const RobotSpec& robot : scenario.robots) {
    problem.starts_m.push_back(robot.start_m);
    problem.goals_m.push_back(robot.goals.back().position_m);
  }
  return problem;
}

double straight_line_s(const JointProblem& problem) {
  double longest_s = 0;
  for (std::size_t i = 0; i < problem.robots(); ++i) {
    const double distance_m = (problem.goals_m[i] - problem.starts_m[i]).norm();
    longest_s = std::max(longest_s, to_seconds(leg_times(distance_m, problem.limits).total()));
  }
  return longest_s;
}

}  // namespace sidestep
