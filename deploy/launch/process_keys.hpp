// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/config/scenario.hpp"
#include "common/keys/key_folder.hpp"
#include "deploy/launch/run.hpp"

namespace sidestep {

/// Whose keys a process of a run has: "agent 3", and so on; "robots" has those of all robots of the scenario.
[[nodiscard]] Identity identity_of_process(const std::string& process, const Scenario& scenario);

/// Gives the launcher of a run with RunOptions::keys those of a judge, after checking that there are keys for
/// every process of the scenario. Throws std::invalid_argument if some are missing.
void use_judge_keys(RunOptions& options, const Scenario& scenario);

}  // namespace sidestep
