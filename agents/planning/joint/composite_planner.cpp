// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/joint/composite_planner.hpp"

#include <algorithm>

#include "agents/planning/joint/leg.hpp"

namespace sidestep {

JointPlan CompositePlanner::plan(const JointProblem& problem, const Budget& budget, Rng& rng) {
  check(problem);
  const CompositeDomain domain(problem);
  JointPlan result;
  if (!domain.check(problem.starts_m, problem.starts_m) || !domain.check(problem.goals_m, problem.goals_m)) {
    result.reason = PlanReason::kUnreachable;
    return result;
  }
  Plan<CompositeDomain::State> path = trees_.plan(domain, problem.starts_m, budget, rng);
  result.samples = path.samples;
  if (!path.arrives()) return result;
  smoother_.smooth(domain, path);
  result.courses = courses_along(path.states, problem.limits);
  result.reason = PlanReason::kSolved;
  return result;
}

std::vector<Course> courses_along(const std::vector<CompositeDomain::State>& path,
                                  const MotionLimits& limits) {
  Time at{};
  std::vector<Course> courses;
  for (const Vec2& start : path.front()) courses.emplace_back(at, start);
  for (std::size_t step = 1; step < path.size(); ++step) {
    const CompositeDomain::State &from = path[step - 1], &to = path[step];
    double longest_m = 0;
    for (std::size_t i = 0; i < from.size(); ++i) longest_m = std::max(longest_m, (to[i] - from[i]).norm());
    const LegTimes times = leg_times(longest_m, limits);
    for (std::size_t i = 0; i < from.size(); ++i)
      if (from[i] != to[i]) courses[i].append(make_leg(at, from[i], to[i], times));
    at += times.total();
  }
  return courses;
}

}  // namespace sidestep
