// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace sidestep {

struct PlanBenchOptions {
  std::vector<std::string> worlds;    ///< none: all
  std::vector<std::string> planners;  ///< none: all
  std::size_t queries = 100;
  std::uint64_t seed = 1;
  double milliseconds = 100;  ///< for a query
};

/// Ours, and OMPL's when built with it.
std::vector<std::string> bench_planner_names();

/// Prints one table: for each world and planner the times of single queries, the lengths over the exact
/// shortest, raw and smoothed, and whether all ways are valid.
void bench_planning(const PlanBenchOptions& options);

}  // namespace sidestep
