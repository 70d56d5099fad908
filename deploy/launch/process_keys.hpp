// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/config/scenario.hpp"
#include "deploy/launch/run.hpp"

namespace sidestep {

/// The folder with the keys of a process of a run, e.g. "agent 3"; empty for a run without keys. Throws
/// std::invalid_argument if there are none.
[[nodiscard]] std::string key_folder_of_process(const RunOptions& options, const std::string& process,
                                                const Scenario& scenario);

/// Throws std::invalid_argument if a run with keys lacks those of a process.
void require_keys(const RunOptions& options, const Scenario& scenario);

}  // namespace sidestep
