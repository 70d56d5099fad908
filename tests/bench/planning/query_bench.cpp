// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/planning/query_bench.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>

#include "tests/bench/planning/significance.hpp"

namespace sidestep {
namespace {

constexpr double kSlack_m = 1e-9;

double length_of(const std::vector<Vec2>& path) {
  double length_m = 0;
  for (std::size_t i = 1; i < path.size(); ++i) length_m += (path[i] - path[i - 1]).norm();
  return length_m;
}

bool answers(const PlanWorld& world, const PlanQuery& query, const std::vector<Vec2>& path) {
  return is_valid_path(world, path, kSlack_m) && (path.front() - query.start_m).norm() <= kSlack_m &&
         (path.back() - query.goal_m).norm() <= kSlack_m;
}

void add(QueryBenchRow& row, const BenchmarkWorld& world, std::size_t query, const TimedPlan& plan) {
  ++row.queries;
  row.plan_us.add(plan.plan_us);
  row.with_smoothing_us.add(plan.plan_us + plan.smoothing_us);
  if (!plan.is_solved) return;
  const PlanQuery& ends = world.world.queries[query];
  if (!answers(world.world, ends, plan.path_m) || !answers(world.world, ends, plan.smoothed_m)) {
    ++row.invalid;
    return;
  }
  ++row.solved;
  row.iterations.add(static_cast<double>(plan.iterations));
  row.length.add(length_of(plan.path_m) / world.shortest_m[query]);
  row.smoothed_length.add(length_of(plan.smoothed_m) / world.shortest_m[query]);
}

const QueryBenchRow* row_of(const std::vector<QueryBenchRow>& rows, const std::string& planner) {
  const auto row =
      std::find_if(rows.begin(), rows.end(), [&](const QueryBenchRow& r) { return r.planner == planner; });
  return row == rows.end() ? nullptr : &*row;
}

}  // namespace

std::vector<QueryBenchRow> bench_queries(const std::vector<PlanWorld>& worlds,
                                         const std::vector<BenchPlanner>& planners, double max_ms,
                                         std::uint64_t seed) {
  Rng rng(seed);
  std::vector<QueryBenchRow> rows;
  for (const BenchPlanner& planner : planners) rows.emplace_back().planner = planner.name;
  std::vector<std::size_t> order(planners.size());
  std::iota(order.begin(), order.end(), 0u);
  for (const PlanWorld& made : worlds) {
    const BenchmarkWorld world(made);
    std::vector<QueryFunction> plan;
    for (const BenchPlanner& planner : planners) {
      plan.push_back(planner.prepare(world, rng.bits()));
      plan.back()(made.queries.front(), max_ms);
    }
    for (std::size_t first = 0; first < made.queries.size(); first += kBlock) {
      const std::size_t end = std::min(first + kBlock, made.queries.size());
      rng.shuffle(order);
      for (const std::size_t i : order)
        for (std::size_t query = first; query < end; ++query)
          add(rows[i], world, query, plan[i](made.queries[query], max_ms));
    }
  }
  return rows;
}

std::vector<std::string> query_bench_failures(const std::vector<QueryBenchRow>& rows,
                                              const std::vector<BenchPlanner>& planners) {
  std::vector<std::string> failures;
  for (const BenchPlanner& planner : planners) {
    const QueryBenchRow* row = row_of(rows, planner.name);
    if (row && row->invalid > 0)
      failures.push_back(fmt::format("{}: {} of {} paths are not valid", planner.name, row->invalid,
                                     row->invalid + row->solved));
    const QueryBenchRow* peer = planner.is_namesake ? row_of(rows, planner.baseline) : nullptr;
    if (!row || !peer) continue;
    const double p = fewer_successes_p(row->solved, row->queries, peer->solved, peer->queries);
    if (p < kSignificance)
      failures.push_back(fmt::format("{} solved {} of {} queries, its peer {} {} of {} (p = {:.2g})",
                                     planner.name, row->solved, row->queries, planner.baseline, peer->solved,
                                     peer->queries, p));
  }
  return failures;
}

std::string query_bench_head() {
  return "| world    | planner                    | over            | solved  | median    | ratio  | p95     "
         "  "
         "| p99       | iterations | smoothed  | length | smoothed | invalid |\n"
         "|----------|----------------------------|-----------------|--------:|----------:|-------:|---------"
         "-:"
         "|----------:|-----------:|----------:|-------:|---------:|--------:|\n";
}

std::string query_bench_lines(const std::string& world, const std::vector<QueryBenchRow>& rows,
                              const std::vector<BenchPlanner>& planners) {
  std::string lines;
  for (const BenchPlanner& planner : planners) {
    const QueryBenchRow* row = row_of(rows, planner.name);
    const QueryBenchRow* baseline = row_of(rows, planner.baseline);
    if (!row) continue;
    const std::string ratio =
        baseline ? fmt::format("{:.2f}", row->plan_us.median() / baseline->plan_us.median()) : "";
    const std::string p99 =
        row->queries >= kMinForP99 ? fmt::format("{:.1f}", row->plan_us.quantile(0.99)) : "";
    lines += fmt::format(
        "| {:<8} | {:<26} | {:<15} | {:>5.1f} % | {:>9.1f} | {:>6} | {:>9.1f} | {:>9} | {:>10.0f} | {:>9.1f} "
        "| "
        "{:>6.3f} | {:>8.3f} | {:>7} |\n",
        world, row->planner, baseline ? planner.baseline : "",
        100.0 * static_cast<double>(row->solved) / static_cast<double>(row->queries), row->plan_us.median(),
        ratio, row->plan_us.quantile(0.95), p99, row->iterations.median(), row->with_smoothing_us.median(),
        row->length.median(), row->smoothed_length.median(), row->invalid);
  }
  return lines;
}

}  // namespace sidestep
