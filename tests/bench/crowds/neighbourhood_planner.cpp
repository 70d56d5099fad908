// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/neighbourhood_planner.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "agents/planning/joint/leg.hpp"
#include "agents/planning/joint/priority_order.hpp"

namespace sidestep {
namespace {

constexpr std::size_t kMaxFirstOrders = 40;  ///< orders that are tried until one gives all robots a course
/// A plan whose robots lose no more than this fraction of their ideal times, on average, is good enough.
constexpr double kGoodLoss = 0.002;
constexpr double kProgress = 0.001;  ///< decrease of this mean that counts as a success

void check_speed_limits(const JointProblem& problem, std::span<const double> speed_limits_mps) {
  if (!speed_limits_mps.empty() && speed_limits_mps.size() != problem.robots())
    throw std::invalid_argument("a joint planning problem needs one speed limit for each robot, or none");
  if (std::ranges::any_of(speed_limits_mps, [](double limit_mps) { return !(limit_mps > 0); }))
    throw std::invalid_argument("speed limits of robots must be positive");
}

bool come_close(const SampledCourse& a, const SampledCourse& b, double separation_m) {
  const std::size_t samples = std::max(a.samples_m.size(), b.samples_m.size());
  for (std::size_t k = 0; k < samples; ++k)
    if ((a.at(k) - b.at(k)).squaredNorm() < separation_m * separation_m) return true;
  return false;
}

}  // namespace

NeighbourhoodPlanner::NeighbourhoodPlanner(const NeighbourhoodSettings& settings) : settings_(settings) {
  if (settings.orders < 1 || settings.replanned < 2 || settings.beam.width < 1 || settings.beam.stops < 1)
    throw std::invalid_argument("a neighbourhood planner needs an order, two robots and a beam");
}

JointPlan NeighbourhoodPlanner::plan(const JointProblem& problem, std::span<const double> speed_limits_mps,
                                     Rng& rng) {
  check(problem);
  check_speed_limits(problem, speed_limits_mps);
  separation_m_ = problem.min_separation_m();
  BeamPlanner planner(problem, settings_.beam);
  JointPlan result;
  set_robots(problem, speed_limits_mps);
  if (!planner.can_rest_at(problem.starts_m) || !planner.can_rest_at(problem.goals_m) ||
      !plan_alone(planner, rng)) {
    result.reason = PlanReason::kUnreachable;
    return result;
  }
  if (find_first_plan(planner, rng)) {
    improve(planner, rng);
    result.reason = PlanReason::kSolved;
    for (const Robot& robot : robots_) result.courses.push_back(robot.course.course);
  }
  result.samples = planner.expanded();
  return result;
}

void NeighbourhoodPlanner::set_robots(const JointProblem& problem, std::span<const double> speed_limits_mps) {
  robots_.assign(problem.robots(), {});
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    BeamQuery& query = robots_[i].query;
    query = {problem.starts_m[i], problem.goals_m[i], problem.limits};
    if (!speed_limits_mps.empty())
      query.limits.speed_mps = std::min(query.limits.speed_mps, speed_limits_mps[i]);
    robots_[i].straight_s =
        to_seconds(leg_times((query.goal_m - query.start_m).norm(), query.limits).total());
  }
}

bool NeighbourhoodPlanner::plan_alone(BeamPlanner& planner, Rng& rng) {
  for (Robot& robot : robots_) {
    const auto course = planner.plan(robot.query, rng);
    if (!course) return false;
    robot.alone = robot.course = *course;
  }
  return true;
}

bool NeighbourhoodPlanner::plan_robot(std::size_t robot, double latest_s, BeamPlanner& planner, Rng& rng) {
  std::vector<TimedPositions> others;
  std::vector<Vec2> waiting_m;
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    if (i == robot) continue;
    if (robots_[i].is_planned)
      others.push_back(robots_[i].course.positions());
    else
      waiting_m.push_back(robots_[i].query.start_m);
  }
  BeamQuery query = robots_[robot].query;
  query.others = others;
  query.waiting_m = waiting_m;
  query.latest_s = latest_s;
  auto course = planner.plan(query, rng);
  if (!course) return false;
  // The search is not exhaustive, so a robot among others may find a faster course than it did alone.
  if (course->arrival_s() < robots_[robot].alone.arrival_s()) robots_[robot].alone = *course;
  robots_[robot].course = std::move(*course);
  robots_[robot].is_planned = true;
  return true;
}

std::size_t NeighbourhoodPlanner::plan_in_order(const std::vector<std::size_t>& order, BeamPlanner& planner,
                                                Rng& rng) {
  for (Robot& robot : robots_) robot.is_planned = false;
  for (std::size_t place = 0; place < order.size(); ++place)
    if (!plan_robot(order[place], BeamQuery{}.latest_s, planner, rng)) return place;
  return order.size();
}

double NeighbourhoodPlanner::mean_loss() const {
  double total = 0;
  for (const Robot& robot : robots_) total += robot.loss();
  return total / static_cast<double>(robots_.size());
}

bool NeighbourhoodPlanner::find_first_plan(BeamPlanner& planner, Rng& rng) {
  std::vector<std::size_t> order(robots_.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return robots_[i].straight_s; });
  std::vector<Robot> best;
  double best_loss = std::numeric_limits<double>::infinity();
  std::size_t plans = 0;
  for (std::size_t tried = 0; tried < kMaxFirstOrders && plans < settings_.orders && best_loss > kGoodLoss;
       ++tried) {
    const std::size_t place = plan_in_order(order, planner, rng);
    if (place < order.size()) {
      move_to_front(order, place, rng);
      continue;
    }
    ++plans;
    if (mean_loss() < best_loss) {
      best_loss = mean_loss();
      best = robots_;
    }
    rng.shuffle(order);
  }
  if (best.empty()) return false;
  robots_ = std::move(best);
  return true;
}

void NeighbourhoodPlanner::improve(BeamPlanner& planner, Rng& rng) {
  const std::size_t patience = settings_.patience * robots_.size(),
                    states = planner.expanded() + settings_.states;
  double loss = mean_loss();
  for (std::size_t i = 0; i < patience && planner.expanded() < states && loss > kGoodLoss; ++i) {
    replan_some(planner, rng);
    if (mean_loss() > loss - kProgress) continue;
    loss = mean_loss();
    i = 0;
  }
}

std::vector<std::size_t> NeighbourhoodPlanner::choose_neighbourhood(Rng& rng) const {
  double total = 0;
  for (const Robot& robot : robots_) total += robot.loss();
  double draw = rng.uniform(0, total);
  std::size_t late = 0;
  while (late + 1 < robots_.size() && (draw -= robots_[late].loss()) > 0) ++late;
  std::vector<std::size_t> in_way;
  for (std::size_t i = 0; i < robots_.size(); ++i)
    if (i != late && come_close(robots_[late].alone, robots_[i].course, separation_m_)) in_way.push_back(i);
  rng.shuffle(in_way);
  std::vector<std::size_t> chosen{late};
  const std::size_t count = std::min(robots_.size(), 2 + rng.below(settings_.replanned - 1));
  for (std::size_t i = 0; i < in_way.size() && chosen.size() < count; ++i) chosen.push_back(in_way[i]);
  while (chosen.size() < count) {
    const std::size_t other = rng.below(robots_.size());
    if (std::ranges::find(chosen, other) == chosen.end()) chosen.push_back(other);
  }
  if (rng.chance(0.5)) rng.shuffle(chosen);
  return chosen;
}

void NeighbourhoodPlanner::replan_some(BeamPlanner& planner, Rng& rng) {
  const std::vector<std::size_t> chosen = choose_neighbourhood(rng);
  std::vector<SampledCourse> before;
  double spare = 0;  // how much the sum of ratios may exceed that of the robots alone
  for (const std::size_t i : chosen) {
    before.push_back(robots_[i].course);
    robots_[i].is_planned = false;
    spare += robots_[i].loss();
  }
  bool is_better = true;
  for (const std::size_t i : chosen) {
    Robot& robot = robots_[i];
    const double latest_s =
        robot.straight_s > 0 ? robot.alone.arrival_s() + spare * robot.straight_s : BeamQuery{}.latest_s;
    is_better = plan_robot(i, latest_s, planner, rng);
    if (!is_better) break;
    spare -= robot.loss();
  }
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    robots_[chosen[k]].is_planned = true;
    if (!is_better) robots_[chosen[k]].course = before[k];
  }
}

}  // namespace sidestep
