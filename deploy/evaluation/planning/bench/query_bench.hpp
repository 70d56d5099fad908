// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/evaluation/planning/bench/bench_planner.hpp"
#include "deploy/evaluation/planning/distribution.hpp"

namespace sidestep {

/// What one planner did on the queries of one world.
struct QueryBenchRow {
  std::string planner;
  std::size_t queries = 0;
  std::size_t solved = 0;       ///< by valid paths from the start to the goal
  std::size_t invalid = 0;      ///< said to be solved, by a path that is not valid, smoothed or not
  Distribution plan_us;         ///< of all queries, unsolved ones included
  Distribution with_smoothing_us;
  Distribution iterations;  ///< where solved
  Distribution length;          ///< over the shortest path's, where solved
  Distribution smoothed_length;
};

/// Planners take turns of this many queries: after the first of them, each finds its own code and data in the
/// processor's caches, as it would alone.
inline constexpr std::size_t kBlock = 20;

/// Gives all planners the same queries in worlds of one kind: block by block, in an order shuffled by the seed
/// for each block, after one query each that does not count. One row for each planner, in their order.
[[nodiscard]] std::vector<QueryBenchRow> bench_queries(const std::vector<PlanWorld>& worlds,
                                                       const std::vector<BenchPlanner>& planners,
                                                       double max_ms, std::uint64_t seed);

/// Namesakes fail below this probability of solving so few queries by chance.
inline constexpr double kSignificance = 0.01;

/// What is wrong with the rows of bench_queries, a sentence each: invalid paths, and namesakes that solve
/// significantly fewer queries than their peers.
[[nodiscard]] std::vector<std::string> query_bench_failures(const std::vector<QueryBenchRow>& rows,
                                                            const std::vector<BenchPlanner>& planners);

/// The rows as lines of a Markdown table, and its head.
[[nodiscard]] std::string query_bench_head();
[[nodiscard]] std::string query_bench_lines(const std::string& world, const std::vector<QueryBenchRow>& rows,
                                            const std::vector<BenchPlanner>& planners);

}  // namespace sidestep
