// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/config/scenario.hpp"
#include "deploy/run/launch/run.hpp"

namespace sidestep {

/// The key folder of a process of a run, for example "agent 3"; empty for a run without keys. Throws
/// std::invalid_argument if the process has no keys.
[[nodiscard]] std::string key_folder_of_process(const RunOptions& options, const std::string& process,
                                                const Scenario& scenario);

/// Throws std::invalid_argument if a run with keys lacks the keys of one of its processes.
void require_keys(const RunOptions& options, const Scenario& scenario);

}  // namespace sidestep
