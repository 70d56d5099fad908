// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/planning/planning_bench_command.hpp"

#include <memory>

#include "common/process/command_line.hpp"
#include "common/process/process.hpp"
#include "tests/bench/planning/planning_bench.hpp"

namespace sidestep {

void add_planning_bench_command(const CliCommand& bench, std::function<int()>& action) {
  const CliCommand command = bench.add_subcommand(
      "planning",
      "All planners in all worlds: time, length, validity. Exits with 1 if a path is invalid, or if our "
      "version of an OMPL planner solves significantly fewer queries than OMPL's (p < 0.01)");
  const auto options = std::make_shared<PlanningBenchOptions>();
  std::vector<std::string> planners;
  for (const BenchPlanner& planner : bench_planners()) planners.push_back(planner.name);
  command.add_option("--world", options->worlds, "run only these worlds").check(one_of(world_names()));
  command.add_option("--planner", options->planners, "run only these planners and OMPL's versions of them")
      .check(one_of(planners));
  command.add_option("--queries", options->queries, "queries in each world; at least 1000 for a p99")
      .check(in_range(1, 1'000'000))
      .show_default();
  command.add_option("--seeds", options->seeds, "number of seeds among which the queries are divided")
      .check(in_range(1, 1000))
      .show_default();
  command.add_option("--seed", options->seed, "first of the consecutive seeds")
      .check(non_negative())
      .show_default();
  command.add_option("--ms", options->max_ms, "time limit of a planner for a query, milliseconds")
      .check(in_range(0.001, 3.6e6))
      .show_default();
  command
      .add_option("--plant", options->planted,
                  "test the benchmark itself: add a faulty planner, which must make the benchmark fail")
      .check(one_of({"invalid-path", "weak-namesake"}));
  command.on_parsed(
      [&action, options] { action = [options] { return bench_planning(*options) ? 0 : kExitFailure; }; });
}

}  // namespace sidestep
