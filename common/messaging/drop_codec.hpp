// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "common/protocol/drop_counters.hpp"
#include "idl/monitor.hpp"

namespace sidestep {

/// Writes the non-zero counts into a message.
void encode(const DropCounters& drops, msg::Counters& message);
/// Decodes untrusted counts. Returns nullopt unless the sender is the process that the counts describe, every
/// reason is known, and every robot number is valid.
[[nodiscard]] std::optional<std::vector<DropCount>> decode(const msg::Counters& message);

}  // namespace sidestep
