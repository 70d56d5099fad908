// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "deploy/evaluation/planning/benchmark_world.hpp"

namespace sidestep {

/// A planner's answer to a query, with the processor time that it took.
struct TimedPlan {
  bool is_solved = false;  ///< what the planner says; the benchmark checks it
  double plan_us = 0, smoothing_us = 0;
  std::size_t iterations = 0;  ///< our samples; a peer's checks of its termination condition
  std::vector<Vec2> path_m, smoothed_m;
};

/// Answers a query within a time limit.
using QueryFunction = std::function<TimedPlan(const PlanQuery& query, double max_ms)>;

/// One row of the benchmark.
struct BenchPlanner {
  std::string name;
  /// The planner whose times it is compared with; empty where there is none.
  std::string baseline;
  /// It is the same algorithm as its baseline, so it must not solve significantly fewer queries.
  bool is_namesake = false;
  /// Prepares a planner for a world, which has to outlive the result.
  std::function<QueryFunction(const BenchmarkWorld&, std::uint64_t seed)> prepare;
};

/// The planners of agents/planning, and OMPL's where it is installed: each namesake after its peer, then the
/// rows that add one thing to the namesake.
[[nodiscard]] std::vector<BenchPlanner> bench_planners();

/// Those with the given names, and the peers of namesakes among them. No names: all.
[[nodiscard]] std::vector<BenchPlanner> select_planners(std::vector<BenchPlanner> all,
                                                        const std::vector<std::string>& names);

/// Planners that the benchmark has to fail: what "invalid-path" returns leads through obstacles;
/// "weak-namesake" gives up every fourth query. Throws std::invalid_argument for another name.
[[nodiscard]] BenchPlanner planted_planner(const std::string& name);

}  // namespace sidestep
