// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace sidestep {

/// The part of an untrusted datagram that may be passed to Fast DDS: everything before the statistics that
/// Fast DDS appends and our processes do not read. Empty if the datagram must be dropped.
///
/// Passes only submessages that processes with keys send, which are encrypted or belong to discovery, and
/// only with plausible lengths, counts and numbers (RTPS 2.2, 9.4.5; DDS Security 1.1, 7.3.6 and 9.5.2). Fast
/// DDS 2.9.1 asserts that statistics come last, decrypts as many bytes as a datagram claims, even beyond its
/// end, and iterates over all numbers up to the one in a heartbeat or a gap.
[[nodiscard]] std::span<const std::uint8_t> checked_datagram(std::span<const std::uint8_t> datagram);

/// Like checked_datagram(), but for a network without keys, on which other software may also send: unknown
/// submessages are passed on.
[[nodiscard]] std::span<const std::uint8_t> without_statistics(std::span<const std::uint8_t> datagram);

}  // namespace sidestep
