// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/keys/identity.hpp"

namespace sidestep {

/// The identities that the words of a command line name, one after another: "agent 0-3 vision client
/// forklift". Each agent and coordinator of a range gets a key of its own, because each is a process of its
/// own; robots of a range share one, as they share sidestep-robot. Throws UsageError that says what is wrong.
[[nodiscard]] std::vector<Identity> parse_key_list(const std::vector<std::string>& words);

/// All identities that a run of the scenario needs: its processes, whatever drives its robots, and those that
/// judge, watch and operate it.
[[nodiscard]] std::vector<Identity> identities_of(const Scenario& scenario);

}  // namespace sidestep
