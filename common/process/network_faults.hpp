// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "common/messaging/dds/dds_bus.hpp"

namespace sidestep {

/// From now on orders of `sidestep fault network` to `target` or to every process change what becomes of the
/// messages that arrive on the bus; each is noted on stderr. Precondition: DdsSettings::faults. The bus must
/// outlive its last callback.
void take_network_faults(DdsBus& bus, std::uint32_t target, const std::string& name);

}  // namespace sidestep
