// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tests/study/problems/benchmark_world.hpp"

namespace sidestep {

/// A planner's answer to a query, with the processor time that it took.
struct TimedPlan {
  bool is_solved = false;  ///< as claimed by the planner; the benchmark checks the claim
  double plan_us = 0, smoothing_us = 0;
  std::size_t iterations = 0;  ///< samples for our planners; checks of the termination condition for OMPL's
  std::vector<Vec2> path_m, smoothed_m;
};

/// Answers a query within a time limit.
using QueryFunction = std::function<TimedPlan(const PlanQuery& query, double max_ms)>;

/// One row of the benchmark.
struct BenchPlanner {
  std::string name;
  /// The planner to which this one's times are compared; empty: none.
  std::string baseline;
  /// Whether this planner implements its baseline's algorithm, and so must not solve significantly fewer
  /// queries.
  bool is_namesake = false;
  /// Prepares a planner for a world, which must outlive the result.
  std::function<QueryFunction(const BenchmarkWorld&, std::uint64_t seed)> prepare;
};

/// The planners of agents/planning, and OMPL's if it is installed. Each namesake (our version of an OMPL
/// planner) follows its peer (OMPL's), then the variants that add one feature to the namesake.
[[nodiscard]] std::vector<BenchPlanner> bench_planners();

/// The planners with the given names, plus the peers of the namesakes among them. No names: all planners.
[[nodiscard]] std::vector<BenchPlanner> select_planners(std::vector<BenchPlanner> all,
                                                        const std::vector<std::string>& names);

/// Faulty planners that the benchmark must detect: "invalid-path" returns paths through obstacles,
/// "weak-namesake" gives up on every fourth query. Throws std::invalid_argument for another name.
[[nodiscard]] BenchPlanner planted_planner(const std::string& name);

}  // namespace sidestep
