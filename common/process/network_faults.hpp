// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/messaging/dds/bus.hpp"

namespace sidestep {

/// Subscribes to the network faults that `sidestep fault network` sends to `target` or to every process,
/// applies them to the messages that arrive on the bus, and logs each. Precondition:
/// DdsSettings::faults. The bus must outlive its last callback.
void apply_network_faults(DdsBus& bus, std::uint32_t target);

}  // namespace sidestep
