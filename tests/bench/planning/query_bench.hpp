// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/bench/planning/bench_planner.hpp"
#include "tests/study/measurement/distribution.hpp"

namespace sidestep {

/// One planner's results on the queries of one kind of world.
struct QueryBenchRow {
  std::string planner;
  std::size_t queries = 0;
  std::size_t solved = 0;   ///< number of queries with a valid path from the start to the goal
  std::size_t invalid = 0;  ///< number claimed to be solved although the raw or the smoothed path is invalid
  Distribution plan_us;     ///< over all queries, including unsolved ones
  Distribution with_smoothing_us;
  Distribution iterations;  ///< over solved queries
  Distribution length;      ///< relative to the shortest path, over solved queries
  Distribution smoothed_length;
};

/// Number of queries that a planner answers per turn. From the second one on, the processor's caches hold the
/// planner's own code and data, as if it ran alone.
inline constexpr std::size_t kBlock = 20;

/// Gives all planners the same queries in worlds of one kind, in blocks of kBlock. The seed shuffles the
/// order of planners in each block. Each planner first answers one query that does not count. Returns one row
/// per planner, in the order of `planners`.
[[nodiscard]] std::vector<QueryBenchRow> bench_queries(const std::vector<PlanWorld>& worlds,
                                                       const std::vector<BenchPlanner>& planners,
                                                       double max_ms, std::uint64_t seed);

/// A namesake fails if the probability of solving so few queries by chance is below this.
inline constexpr double kSignificance = 0.01;

/// The failures in the rows of bench_queries, one sentence each: invalid paths, and namesakes that solve
/// significantly fewer queries than their peers.
[[nodiscard]] std::vector<std::string> query_bench_failures(const std::vector<QueryBenchRow>& rows,
                                                            const std::vector<BenchPlanner>& planners);

/// The header and the rows of a Markdown table.
[[nodiscard]] std::string query_bench_head();
[[nodiscard]] std::string query_bench_lines(const std::string& world, const std::vector<QueryBenchRow>& rows,
                                            const std::vector<BenchPlanner>& planners);

}  // namespace sidestep
