// SPDX-License-Identifier: Apache-2.0
#include "tests/study/joint_planning/joint_trial.hpp"

#include <fmt/format.h>

#include "agents/planning/joint/composite_planner.hpp"
#include "agents/planning/joint/prioritised_planner.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/study/joint_planning/joint_check.hpp"
#include "tests/study/joint_planning/joint_scene.hpp"
#include "tests/study/measurement/cpu_clock.hpp"

namespace sidestep {
namespace {

double microseconds(Duration duration) { return 1e6 * to_seconds(duration); }

/// Maximum duration without preemption: a thread that is not preempted plans within a few tens of
/// microseconds.
constexpr Duration kPreempted = std::chrono::milliseconds(1);

/// The sum of a histogram's durations, each counted as the upper edge of its bucket. Excludes durations that
/// contain a preemption.
double sum_us(const DurationHistogram& histogram) {
  double sum = 0;
  for (std::size_t i = 0; DurationHistogram::upper_edge(i) <= kPreempted; ++i)
    sum += static_cast<double>(histogram.buckets()[i]) * microseconds(DurationHistogram::upper_edge(i));
  return sum;
}

JointTrial drive(const Scenario& scenario, const JointProblem& problem, std::uint64_t seed) {
  SimSystem system(scenario, seed);
  JointTrial trial;
  trial.solved = system.run_until_arrived(system.begin() + from_seconds(scenario.time_limit_s));
  const Report report = system.metrics().report();
  if (report.contacts > 0) trial.fault = fmt::format("{} contacts", report.contacts);
  trial.plan_us = sum_us(report.plan);
  trial.cycle_us = microseconds(report.plan.quantile(0.5));
  trial.cycle_p99_us = microseconds(report.plan.quantile(0.99));
  trial.solved = trial.solved && report.makespan_s.has_value();
  if (trial.solved) trial.makespan_ratio = *report.makespan_s / straight_line_s(problem);
  return trial;
}

template <typename Planner>
JointTrial plan(const Scenario& scenario, const JointProblem& problem, double budget_s, std::uint64_t seed) {
  // Only time limits the effort.
  constexpr std::size_t kUnlimited = 100'000'000;
  Rng rng(seed);
  Planner planner;
  const double begin_us = cpu_us();
  const Budget budget{kUnlimited, kUnlimited, cpu_time() + from_seconds(budget_s), cpu_time};
  const JointPlan plan = planner.plan(problem, budget, rng);
  JointTrial trial;
  trial.plan_us = cpu_us() - begin_us;
  trial.solved = plan.arrives();
  if (!trial.solved) return trial;
  trial.fault = fault_of(problem, scenario.obstacles, plan.courses);
  trial.makespan_ratio = plan.makespan_s() / straight_line_s(problem);
  return trial;
}

}  // namespace

const char* name_of(JointMethod method) {
  switch (method) {
    case JointMethod::kComposite:
      return "composite";
    case JointMethod::kPrioritised:
      return "prioritised";
    default:
      return "safety search";
  }
}

JointTrial run_joint_trial(JointMethod method, const Scenario& scenario, double budget_s,
                           std::uint64_t seed) {
  const ObstacleWorld world(scenario.obstacles);
  const JointProblem problem = joint_problem(scenario, world);
  switch (method) {
    case JointMethod::kComposite:
      return plan<CompositePlanner>(scenario, problem, budget_s, seed);
    case JointMethod::kPrioritised:
      return plan<PrioritisedPlanner>(scenario, problem, budget_s, seed);
    default:
      return drive(scenario, problem, seed);
  }
}

}  // namespace sidestep
