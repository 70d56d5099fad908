// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/planning/replan_bench.hpp"

#include <fmt/format.h>

#include "deploy/evaluation/planning/cpu_clock.hpp"
#include "deploy/evaluation/planning/named_planner.hpp"
#include "deploy/evaluation/planning/numbers.hpp"
#include "deploy/evaluation/planning/ompl_planner.hpp"
#include "deploy/evaluation/planning/replan_course.hpp"

namespace sidestep {
namespace {

constexpr std::size_t kCycles = 2670;

struct Row {
  int solved = 0, invalid = 0;
  Numbers plan_us;
};

Row replan(NamedPlanner& planner, std::uint64_t seed) {
  Rng rng(seed);
  ReplanCourse course(kCycles, seed);
  Row row;
  for (std::size_t i = 0; i < kCycles; ++i) {
    course.step();
    const DiscDomain domain = course.domain();
    const double begin_us = cpu_us();
    const Plan<Vec2>& plan = planner.plan(domain, course.start_m(), kReplanBudget, rng);
    row.plan_us.add(cpu_us() - begin_us);
    if (plan.arrives()) ++row.solved;
    if (!course.is_valid(plan.states)) ++row.invalid;
  }
  return row;
}

}  // namespace

void bench_replanning(const PlanBenchOptions& options) {
  fmt::print("\n{} plans at 60 Hz among 64 circles that move at {} m/s, microseconds of one core.\n\n",
             kCycles, ReplanCourse::kObstacleSpeed_mps);
  fmt::print("| planner          | solved  | median    | p95       | p99       | mean      | invalid |\n");
  fmt::print("|------------------|--------:|----------:|----------:|----------:|----------:|--------:|\n");
  for (const std::string& name : options.planners.empty() ? planner_names() : options.planners) {
    if (is_ompl_planner(name)) continue;
    NamedPlanner planner = make_planner(name);
    if (planner.kind != PlannerKind::kForAnyWorld) continue;
    const Row row = replan(planner, options.seed);
    fmt::print("| {:<16} | {:>5.1f} % | {:>9.1f} | {:>9.1f} | {:>9.1f} | {:>9.1f} | {:>7} |\n", name,
               100.0 * row.solved / double(kCycles), row.plan_us.at(0.5), row.plan_us.at(0.95),
               row.plan_us.at(0.99), row.plan_us.mean(), row.invalid);
    std::fflush(stdout);
  }
}

}  // namespace sidestep
