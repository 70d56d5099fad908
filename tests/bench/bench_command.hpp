// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `bench` with its benchmarks. Parsing one of them sets `action`, which returns the exit code.
void add_bench_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
