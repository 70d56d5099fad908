// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/messaging/dds/presence.hpp"

namespace sidestep {

using Datagram = std::vector<std::uint8_t>;

/// The sender of an RTPS datagram, or of its first part; nullopt if it has no RTPS header.
[[nodiscard]] std::optional<ParticipantId> sender_of(std::span<const std::uint8_t> datagram);

/// The datagram with which a participant would announce that it leaves (RTPS 2.2, 8.5.3: it disposes its
/// participant data). Passed to Fast DDS, it makes Fast DDS forget the participant.
Datagram departure_of(const ParticipantId& participant);

/// A presence announcement: an RTPS datagram with a vendor-specific submessage, which other software skips.
Datagram presence_datagram(const ParticipantId& sender, std::span<const PresenceNotice> notices);

/// The notices of a presence announcement; nullopt if the datagram is none. The datagram is untrusted.
[[nodiscard]] std::optional<std::vector<PresenceNotice>> presence_notices(
    std::span<const std::uint8_t> datagram);

}  // namespace sidestep
