// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/joint/prioritised_planner.hpp"

#include <algorithm>
#include <numeric>

#include "agents/planning/joint/composite_domain.hpp"
#include "agents/planning/joint/priority_order.hpp"
#include "agents/planning/joint/space_time_path.hpp"

namespace sidestep {
namespace {

constexpr std::size_t kPlansPerRobot = 8;       ///< the plan with the earliest arrival is kept
constexpr std::size_t kSamplesPerRobot = 1500;  ///< samples of one tree before another order is tried
constexpr std::size_t kMaxOrders = 1000;        ///< maximum number of orders of robots that are tried

bool is_spent(const Budget& budget, std::size_t samples) {
  return samples >= budget.samples || (budget.clock && budget.clock() >= budget.until);
}

}  // namespace

JointPlan PrioritisedPlanner::plan(const JointProblem& problem, const Budget& budget, Rng& rng) {
  check(problem);
  JointPlan result;
  const CompositeDomain all(problem);
  if (!all.check(problem.starts_m, problem.starts_m) || !all.check(problem.goals_m, problem.goals_m)) {
    result.reason = PlanReason::kUnreachable;
    return result;
  }
  trees_.assign(problem.robots(), Tree());
  std::vector<std::size_t> order(problem.robots());
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = 0; i < kMaxOrders && !is_spent(budget, result.samples); ++i) {
    const std::size_t place = plan_in_order(problem, order, budget, rng, result);
    if (place == order.size()) {
      result.reason = PlanReason::kSolved;
      return result;
    }
    move_to_front(order, place, rng);
  }
  result.courses.clear();
  return result;
}

std::size_t PrioritisedPlanner::plan_in_order(const JointProblem& problem,
                                              const std::vector<std::size_t>& order, const Budget& budget,
                                              Rng& rng, JointPlan& result) {
  std::vector<Course> planned;  // courses, in the order of planning
  for (std::size_t place = 0; place < order.size(); ++place) {
    if (is_spent(budget, result.samples)) return place;
    const std::size_t robot = order[place];
    const SpaceTimeDomain domain(problem, robot, planned);
    const std::vector<SpaceTimeState> path = path_of(robot, domain, budget, rng, result.samples);
    if (path.empty()) return place;
    planned.push_back(course_along(path, problem.limits));
  }
  result.courses.resize(order.size());
  for (std::size_t place = 0; place < order.size(); ++place) result.courses[order[place]] = planned[place];
  return order.size();
}

std::vector<SpaceTimeState> PrioritisedPlanner::path_of(std::size_t robot, const SpaceTimeDomain& domain,
                                                        const Budget& budget, Rng& rng,
                                                        std::size_t& samples) {
  std::vector<SpaceTimeState> best;
  for (std::size_t i = 0; i < kPlansPerRobot && !is_spent(budget, samples); ++i) {
    Budget share = budget;
    share.nodes = kSamplesPerRobot + 1;
    share.samples = std::min(kSamplesPerRobot, budget.samples - samples);
    const Plan<SpaceTimeState>& plan = trees_[robot].plan(domain, domain.start(), share, rng);
    samples += plan.samples;
    if (!plan.arrives()) break;
    std::vector<SpaceTimeState> path = plan.states;
    shorten(domain, path);
    if (best.empty() || path.back().at < best.back().at) best = std::move(path);
    if (best.back().at == domain.goal(domain.start()).at) break;
  }
  return best;
}

}  // namespace sidestep
