// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/bench/planning/bench_planner.hpp"

namespace sidestep {

struct PlanningBenchOptions {
  std::vector<std::string> worlds;    ///< empty: all worlds
  std::vector<std::string> planners;  ///< empty: all planners
  std::string planted;                ///< see planted_planner(); empty: none
  std::size_t queries = 1000;         ///< number of queries for each kind of world
  std::size_t seeds = 5;              ///< number of worlds of each kind; the queries are divided among them
  std::uint64_t seed = 1;             ///< the first seed
  double max_ms = 100;                ///< time limit of a query
};

/// Prints how OMPL and this project were compiled, a table of queries for each kind of world, the table of
/// replans, and the failures. Returns whether all paths were valid and no namesake solved significantly fewer
/// queries than its baseline.
[[nodiscard]] bool bench_planning(const PlanningBenchOptions& options);

}  // namespace sidestep
