// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/planning/replan_bench.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>

#include "agents/planning/named_planner.hpp"
#include "tests/study/measurement/cpu_clock.hpp"
#include "tests/study/measurement/distribution.hpp"
#include "tests/study/problems/replan_course.hpp"

namespace sidestep {
namespace {

struct Row {
  NamedPlanner planner;
  Rng rng;
  std::size_t solved = 0, invalid = 0;
  Distribution plan_us{};
};

std::vector<Row> rows_of(const std::vector<std::string>& names, std::uint64_t seed) {
  Rng seeds(seed);
  std::vector<Row> rows;
  for (const std::string& name : planner_names()) {
    NamedPlanner planner = make_planner(name);
    const bool is_wanted = names.empty() || std::find(names.begin(), names.end(), name) != names.end();
    if (is_wanted && planner.kind == PlannerKind::kForAnyWorld) rows.push_back({planner, seeds.fork()});
  }
  return rows;
}

void replan(const ReplanCourse& course, Row& row) {
  // The settings depend only on the field and the radius, whose defaults are those of the benchmark's worlds.
  const DiscDomainSettings settings = row.planner.domain_settings(PlanWorld{}.field, PlanWorld{}.radius_m);
  const double begin_us = cpu_us();
  const DiscDomain domain = course.domain(settings);
  const Plan<Vec2>& plan = row.planner.plan(domain, course.start_m(), kReplanBudget, row.rng);
  row.plan_us.add(cpu_us() - begin_us);
  if (!course.is_valid(plan.states)) {
    ++row.invalid;
  } else if (plan.arrives()) {
    ++row.solved;
  }
}

void print(const std::vector<Row>& rows, std::size_t cycles) {
  fmt::print(
      "| planner                    | solved  | median    | p95       | p99       | mean      | invalid |\n"
      "|----------------------------|--------:|----------:|----------:|----------:|----------:|--------:|\n");
  for (const Row& row : rows) {
    const std::string p99 = cycles >= kMinForP99 ? fmt::format("{:.1f}", row.plan_us.quantile(0.99)) : "";
    fmt::print("| {:<26} | {:>5.1f} % | {:>9.1f} | {:>9.1f} | {:>9} | {:>9.1f} | {:>7} |\n", row.planner.name,
               100.0 * static_cast<double>(row.solved) / static_cast<double>(cycles), row.plan_us.median(),
               row.plan_us.quantile(0.95), p99, row.plan_us.mean(), row.invalid);
  }
  std::fflush(stdout);
}

}  // namespace

std::vector<std::string> bench_replanning(const std::vector<std::string>& planners, std::size_t cycles,
                                          std::uint64_t seed) {
  std::vector<Row> rows = rows_of(planners, seed);
  if (rows.empty()) return {};
  fmt::print(
      "\n{} replans at 60 Hz among 64 circles that move at {} m/s; microseconds of processor time.\n\n",
      cycles, ReplanCourse::kObstacleSpeed_mps);
  ReplanCourse course(cycles, seed);
  std::vector<std::size_t> order(rows.size());
  std::iota(order.begin(), order.end(), 0u);
  Rng rng(seed);
  for (std::size_t cycle = 0; cycle < cycles; ++cycle) {
    course.step();
    rng.shuffle(order);
    for (const std::size_t i : order) replan(course, rows[i]);
  }
  print(rows, cycles);
  std::vector<std::string> failures;
  for (const Row& row : rows)
    if (row.invalid > 0)
      failures.push_back(
          fmt::format("{}: {} of {} replans are not valid", row.planner.name, row.invalid, cycles));
  return failures;
}

}  // namespace sidestep
