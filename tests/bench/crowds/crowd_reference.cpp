// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/crowd_reference.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <stdexcept>
#include <vector>

#include "agents/planning/joint/leg.hpp"
#include "agents/planning/visibility/tangent_graph.hpp"
#include "deploy/audit/metrics/straight_line_time.hpp"
#include "tests/study/joint_planning/joint_check.hpp"
#include "tests/study/joint_planning/joint_scene.hpp"
#include "tests/study/measurement/cpu_clock.hpp"

namespace sidestep {
namespace {

void check_scene(const Scenario& scenario) {
  if (!scenario.opponents.empty() || scenario.map)
    throw std::invalid_argument("the reference plans scenes without opponents and without a map");
  for (const RobotSpec& robot : scenario.robots)
    if (robot.goals.size() != 1)
      throw std::invalid_argument(fmt::format("the reference needs one goal for robot {}, which has {}",
                                              robot.id, robot.goals.size()));
}

JointProblem problem_without_margin(const Scenario& scenario, const ObstacleWorld& world) {
  JointProblem problem = joint_problem(scenario, world);
  problem.margin_m = 0;
  return problem;
}

std::vector<double> speed_limits_mps(const Scenario& scenario) {
  std::vector<double> limits_mps;
  for (const RobotSpec& robot : scenario.robots)
    limits_mps.push_back(limits_to(robot.goals.front(), scenario.limits).speed_mps);
  return limits_mps;
}

}  // namespace

JointPlan plan_reference(const Scenario& scenario, std::uint64_t seed,
                         const NeighbourhoodSettings& settings) {
  check_scene(scenario);
  const ObstacleWorld world(scenario.obstacles);
  const JointProblem problem = problem_without_margin(scenario, world);
  Rng rng(seed);
  return NeighbourhoodPlanner(settings).plan(problem, speed_limits_mps(scenario), rng);
}

CrowdResult crowd_result_of(const Scenario& scenario, const JointPlan& plan) {
  CrowdResult result;
  result.robots = static_cast<int>(scenario.robots.size());
  if (!plan.arrives()) return result;
  result.arrived = result.robots;
  const ObstacleWorld world(scenario.obstacles);
  const JointProblem problem = problem_without_margin(scenario, world);
  if (!fault_of(problem, scenario.obstacles, plan.courses, speed_limits_mps(scenario)).empty())
    result.violations = 1;
  std::vector<std::optional<double>> arrivals_s;
  for (const Course& course : plan.courses) arrivals_s.push_back(to_seconds(course.end() - Time{}));
  result.ratio = straight_line_time_ratio(scenario.robots, arrivals_s, scenario.limits);
  result.makespan_s = plan.makespan_s();
  return result;
}

CrowdResult run_reference(const Scenario& scenario, std::uint64_t seed) {
  const double begin_us = cpu_us();
  const JointPlan plan = plan_reference(scenario, seed);
  const double planning_us = cpu_us() - begin_us;
  CrowdResult result = crowd_result_of(scenario, plan);
  const double cycles = std::max(1.0, plan.makespan_s() / to_seconds(scenario.cycle));
  result.cpu_us = planning_us / (result.robots * cycles);
  return result;
}

double lower_bound_ratio(const Scenario& scenario) {
  check_scene(scenario);
  constexpr double kTolerance_m = 1e-6;  // for the distance that the graph's paths keep from obstacles
  const ObstacleWorld world(scenario.obstacles);
  TangentGraph graph(world, scenario.field, scenario.radius_m - kTolerance_m);
  std::vector<std::optional<double>> times_s;
  for (const RobotSpec& robot : scenario.robots) {
    const Goal& goal = robot.goals.front();
    graph.plan(robot.start_m, goal.position_m);
    if (!std::isfinite(graph.shortest_m())) return graph.shortest_m();
    times_s.push_back(to_seconds(leg_times(graph.shortest_m(), limits_to(goal, scenario.limits)).total()));
  }
  return straight_line_time_ratio(scenario.robots, times_s, scenario.limits).value_or(1);
}

}  // namespace sidestep
