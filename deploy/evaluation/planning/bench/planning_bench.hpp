// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/evaluation/planning/bench/bench_planner.hpp"

namespace sidestep {

struct PlanningBenchOptions {
  std::vector<std::string> worlds;    ///< none: all
  std::vector<std::string> planners;  ///< none: all
  std::string planted;                ///< see planted_planner; empty: none
  std::size_t queries = 1000;         ///< in each world
  std::size_t seeds = 5;              ///< worlds of each kind, among which the queries are divided
  std::uint64_t seed = 1;             ///< the first
  double max_ms = 100;                ///< for a query
};

/// Prints how both sides were compiled, the table of queries for each world, the table of replans, and what
/// failed. Returns whether all paths were valid and no namesake solved significantly fewer queries than its
/// peer.
[[nodiscard]] bool bench_planning(const PlanningBenchOptions& options);

}  // namespace sidestep
