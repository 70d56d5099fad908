// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/messaging/dds/bus.hpp"

namespace sidestep {

/// Subscribes to the network faults that `sidestep fault network` sends to `target` or to all processes.
/// Applies them to messages that arrive on the bus, and logs each. Preconditions: DdsSettings::faults; the
/// bus outlives its last callback.
void apply_network_faults(DdsBus& bus, std::uint32_t target);

}  // namespace sidestep
