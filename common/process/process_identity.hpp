// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/config/scenario.hpp"
#include "common/keys/identity.hpp"

namespace sidestep {

/// Whose keys the process with this number (common/messaging/senders.hpp) has in a run of the scenario; the
/// process that drives the robots has those of all robots. Throws std::logic_error for numbers of no process.
[[nodiscard]] Identity identity_of_process(std::uint32_t process, const Scenario& scenario);

}  // namespace sidestep
