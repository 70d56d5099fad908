// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/keys/identity.hpp"

namespace sidestep {

/// Parses the identities in the words of a command line, such as "agent 0-3 vision client forklift". Every
/// agent or coordinator in a range gets its own key, because each is a separate process. The robots of a
/// range share one key, because they share a sidestep-robot process. Throws UsageError with what is wrong.
[[nodiscard]] std::vector<Identity> parse_key_list(const std::vector<std::string>& words);

/// All identities that a run of the scenario needs: its processes, the program that drives its robots, and
/// the programs that judge, watch and operate the run.
[[nodiscard]] std::vector<Identity> identities_of(const Scenario& scenario);

}  // namespace sidestep
