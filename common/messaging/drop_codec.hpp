// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "common/protocol/drop_counters.hpp"
#include "idl/monitor.hpp"

namespace sidestep {

/// Fills in the counts that are not zero.
void encode(const DropCounters& drops, msg::Counters& message);
/// Decodes untrusted counts. Returns nullopt unless their sender is the process that they are of, every
/// reason is known, and every robot possible.
[[nodiscard]] std::optional<std::vector<DropCount>> decode(const msg::Counters& message);

}  // namespace sidestep
