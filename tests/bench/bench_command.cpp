// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/bench_command.hpp"

#include "tests/bench/crowds/crowd_bench_command.hpp"
#include "tests/bench/planning/planning_bench_command.hpp"

namespace sidestep {

void add_bench_command(const CliCommand& root, std::function<int()>& action) {
  const CliCommand bench =
      root.add_subcommand("bench", "Benchmarks parts of the system against other libraries");
  bench.require_subcommand();
  add_planning_bench_command(bench, action);
  add_crowd_bench_command(bench, action);
}

}  // namespace sidestep
