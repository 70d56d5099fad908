// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/messaging/impairment.hpp"

namespace sidestep {

/// The message, without its header, that impairs all messages arriving at a process from then on. `target` is
/// the process id or kEveryProcess (common/protocol/senders.hpp).
[[nodiscard]] msg::NetworkFault encode(const LinkQuality& quality, std::uint32_t target, std::uint64_t seed);

}  // namespace sidestep
