// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace sidestep {

/// What Fast DDS may be given of a datagram: its beginning, without the statistics that Fast DDS adds to its
/// end and nobody here reads; nothing if the datagram must be dropped. Untrusted.
///
/// Passes only submessages that processes with keys send, with the lengths, counts and numbers that these
/// have (RTPS 2.2, 9.4.5; DDS Security 1.1, 7.3.6 and 9.5.2): encrypted ones, and those of discovery. Fast
/// DDS 2.9.1 asserts that statistics are last, decrypts as many bytes as a datagram says, beyond its end, and
/// visits every
/// number up to the one that a heartbeat or a gap states.
[[nodiscard]] std::span<const std::uint8_t> checked_datagram(std::span<const std::uint8_t> datagram);

/// As checked_datagram() for a network without keys, on which other software may speak too: submessages that
/// it does not know are passed on.
[[nodiscard]] std::span<const std::uint8_t> without_statistics(std::span<const std::uint8_t> datagram);

}  // namespace sidestep
