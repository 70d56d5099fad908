// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/planning/planning_bench.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "tests/bench/planning/ompl_planner.hpp"
#include "tests/bench/planning/query_bench.hpp"
#include "tests/bench/planning/replan_bench.hpp"

namespace sidestep {
namespace {

std::vector<BenchPlanner> planners_of(const PlanningBenchOptions& options) {
  if (options.planted.empty()) return select_planners(bench_planners(), options.planners);
  const BenchPlanner planted = planted_planner(options.planted);
  std::vector<std::string> names = options.planners;
  if (!names.empty() && !planted.baseline.empty()) names.push_back(planted.baseline);
  std::vector<BenchPlanner> planners = select_planners(bench_planners(), names);
  planners.push_back(planted);
  return planners;
}

/// Worlds of one kind, one for each seed, with the queries divided among them.
std::vector<PlanWorld> worlds_of(const std::string& name, const PlanningBenchOptions& options) {
  std::vector<PlanWorld> worlds;
  const std::size_t seeds = std::min(options.seeds, options.queries);
  for (std::size_t i = 0; i < seeds; ++i) {
    const std::size_t queries = options.queries * (i + 1) / seeds - options.queries * i / seeds;
    worlds.push_back(make_world(name, queries, options.seed + i));
  }
  return worlds;
}

void print_head(const PlanningBenchOptions& options) {
  fmt::print(
      "{}\nsidestep: {}. The collision checks, which both sides call, are compiled for the baseline, AVX2 "
      "and\n"
      "AVX-512, and the best is chosen at run time.\n\n",
      ompl_build(), SIDESTEP_BUILD);
  fmt::print(
      "{} queries in each world, seeds {} to {}, at most {} ms each; planners take turns of {} queries, in "
      "shuffled\norder. Microseconds of processor time. solved: by a valid path; an exact decision says that "
      "all "
      "queries are\nsolvable. A query that is not solved counts with the time it took. ratio: of the "
      "medians, to "
      "the planner in the\ncolumn `over`. iterations: median over solved queries. smoothed: median with each "
      "library's own smoothing.\nLengths: medians over the shortest path's.\n\n",
      options.queries, options.seed, options.seed + std::min(options.seeds, options.queries) - 1,
      options.max_ms, kBlock);
  fmt::print("{}", query_bench_head());
  std::fflush(stdout);
}

}  // namespace

bool bench_planning(const PlanningBenchOptions& options) {
  const std::vector<BenchPlanner> planners = planners_of(options);
  std::vector<std::string> failures;
  print_head(options);
  for (const std::string& world : options.worlds.empty() ? world_names() : options.worlds) {
    const auto rows = bench_queries(worlds_of(world, options), planners, options.max_ms, options.seed);
    fmt::print("{}", query_bench_lines(world, rows, planners));
    std::fflush(stdout);
    for (const std::string& failure : query_bench_failures(rows, planners))
      failures.push_back(fmt::format("{}: {}", world, failure));
  }
  if (options.worlds.empty()) {
    const std::size_t cycles =
        std::min(kReplanCycles, options.queries >= kMinForP99 ? kReplanCycles : options.queries);
    const auto more = bench_replanning(options.planners, cycles, options.seed);
    failures.insert(failures.end(), more.begin(), more.end());
  }
  fmt::print("\n");
  for (const std::string& failure : failures) fmt::print("FAILED: {}\n", failure);
  if (failures.empty())
    fmt::print("All paths are valid, and no namesake solved significantly fewer queries than its peer.\n");
  return failures.empty();
}

}  // namespace sidestep
