// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `crowds`. Parsing it sets `action`, which returns the exit code.
void add_crowd_bench_command(const CliCommand& bench, std::function<int()>& action);

/// The seeds in a range "FIRST..LAST" of one parity: "even", "odd" or "all". Throws UsageError if there is
/// none.
[[nodiscard]] std::vector<std::uint64_t> seeds_in(const std::string& range, const std::string& parity);

}  // namespace sidestep
