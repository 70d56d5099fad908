// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/evaluation/planning/plan_bench.hpp"

namespace sidestep {

/// Prints what planning anew in each of 2,670 cycles of a sixtieth of a second costs, while obstacles move
/// and the robot drives: 64 circles that go to and fro, and goals one after the other. All planners get the
/// same starts, goals and obstacles.
void bench_replanning(const PlanBenchOptions& options);

}  // namespace sidestep
