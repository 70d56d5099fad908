// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/config/scenario.hpp"
#include "common/keys/identity.hpp"

namespace sidestep {

/// The identity whose keys the process with this id (common/protocol/senders.hpp) has in a run of the
/// scenario. The process that drives the robots has the keys of all robots. Throws std::logic_error for
/// unknown ids.
[[nodiscard]] Identity identity_of_process(std::uint32_t process, const Scenario& scenario);

}  // namespace sidestep
