// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/planning/plan_bench.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <memory>

#include "agents/planning/smoothing/leader_follower.hpp"
#include "deploy/evaluation/planning/cpu_clock.hpp"
#include "deploy/evaluation/planning/ground.hpp"
#include "deploy/evaluation/planning/named_planner.hpp"
#include "deploy/evaluation/planning/numbers.hpp"
#include "deploy/evaluation/planning/ompl_planner.hpp"

namespace sidestep {
namespace {

constexpr double kStep_m = 0.005, kSlack_m = 1e-9;

Time now() { return time_from_ns(static_cast<std::int64_t>(1e3 * cpu_us())); }

struct Row {
  int asked = 0, solved = 0, invalid = 0;
  Numbers plan_us, both_us, raw, smooth;  // lengths over the shortest

  void add(const Ground& ground, std::size_t query, const BenchedPlan& plan) {
    ++asked;
    plan_us.add(plan.plan_us);
    both_us.add(plan.plan_us + plan.smooth_us);
    if (!plan.solved) return;
    ++solved;
    raw.add(length_of(plan.raw) / ground.shortest_m[query]);
    smooth.add(length_of(plan.smooth) / ground.shortest_m[query]);
    for (const auto* way : {&plan.raw, &plan.smooth})
      if (!is_valid_way(ground.world, *way, kStep_m, kSlack_m)) ++invalid;
  }

  static double length_of(const std::vector<Vec2>& way) {
    double length = 0;
    for (std::size_t i = 1; i < way.size(); ++i) length += (way[i] - way[i - 1]).norm();
    return length;
  }
};

BenchedPlan plan_with(NamedPlanner& planner, LeaderFollower<DiscDomain>& smoother, const Ground& ground,
                      const PlanQuery& query, double milliseconds, Rng& rng) {
  // Anytime planners would use all of their time: samples end them.
  Budget budget{.until = now() + from_seconds(1e-3 * milliseconds), .clock = now};
  if (planner.kind == PlannerKind::kAnytime) budget.samples = 2000;
  const double begin_us = cpu_us();
  const DiscDomain domain(ground.obstacles, ground.world.field, ground.world.radius_m, query.start_m,
                          query.goal_m);
  const Plan<Vec2>& found = planner.plan(domain, query.start_m, budget, rng);
  const double planned_us = cpu_us();
  BenchedPlan plan;
  Plan<Vec2> smooth = found;
  const double copied_us = cpu_us();
  smoother.smooth(domain, smooth);
  plan.plan_us = planned_us - begin_us;
  plan.smooth_us = cpu_us() - copied_us;
  plan.solved = found.arrives();
  plan.raw = found.states;
  plan.smooth = smooth.states;
  return plan;
}

Row measure(const Ground& ground, const std::string& name, const PlanBenchOptions& options) {
  Row row;
  Rng rng(options.seed);
  const auto& queries = ground.world.queries;
  if (is_ompl_planner(name)) {
    OmplPlanner planner(name, ground.world, ground.obstacles, options.seed);
    for (std::size_t i = 0; i < queries.size(); ++i)
      row.add(ground, i, planner.plan(queries[i], options.milliseconds));
    return row;
  }
  NamedPlanner planner = make_planner(name);
  LeaderFollower<DiscDomain> smoother;
  // The first query pays for memory, and for what is built once.
  plan_with(planner, smoother, ground, queries[0], options.milliseconds, rng);
  for (std::size_t i = 0; i < queries.size(); ++i)
    row.add(ground, i, plan_with(planner, smoother, ground, queries[i], options.milliseconds, rng));
  return row;
}

void print(const std::string& world, const std::string& planner, const Row& row) {
  fmt::print(
      "| {:<8} | {:<16} | {:>5.0f} % | {:>9.1f} | {:>9.1f} | {:>9.1f} | {:>9.1f} | {:>6.3f} | {:>6.3f} | "
      "{:>7} |\n",
      world, planner, 100.0 * row.solved / row.asked, row.plan_us.at(0.5), row.plan_us.at(0.95),
      row.plan_us.at(0.99), row.both_us.at(0.5), row.raw.at(0.5), row.smooth.at(0.5), row.invalid);
  std::fflush(stdout);
}

}  // namespace

std::vector<std::string> bench_planner_names() {
  std::vector<std::string> names = planner_names();
  for (const std::string& name : ompl_planner_names()) names.push_back(name);
  return names;
}

void bench_planning(const PlanBenchOptions& options) {
  fmt::print(
      "{} queries in each world, seed {}, at most {} ms each. Times in microseconds of one core; lengths are "
      "medians "
      "over the exact shortest.\n\n",
      options.queries, options.seed, options.milliseconds);
  fmt::print(
      "| world    | planner          | solved  | median    | p95       | p99       | smoothed  | raw    | "
      "smooth | invalid |\n");
  fmt::print(
      "|----------|------------------|--------:|----------:|----------:|----------:|----------:|-------:|----"
      "---:|--------:|\n");
  for (const std::string& world : options.worlds.empty() ? world_names() : options.worlds) {
    const Ground ground(make_world(world, options.queries, options.seed));
    for (const std::string& planner : options.planners.empty() ? bench_planner_names() : options.planners)
      print(world, planner, measure(ground, planner, options));
  }
}

}  // namespace sidestep
