// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace sidestep {

/// Whether the payload is a message of a handshake as processes with keys send it (DDS Security 1.1, 7.4.3.4
/// and 9.3.2.5): one token whose properties have known names and possible sizes. Untrusted. Fast DDS 2.9.1
/// believes the sizes that such a message states.
[[nodiscard]] bool is_handshake_message(std::span<const std::uint8_t> payload);

}  // namespace sidestep
