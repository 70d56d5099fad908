// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace sidestep {

/// Whether the untrusted payload is a handshake message such as processes with keys send (DDS Security 1.1,
/// 7.4.3.4 and 9.3.2.5): one token whose properties have known names and plausible sizes. Fast DDS 2.9.1
/// trusts the sizes that such a message states.
[[nodiscard]] bool is_handshake_message(std::span<const std::uint8_t> payload);

}  // namespace sidestep
