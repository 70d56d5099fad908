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

/// What a datagram says of the discovery of participants. Untrusted.
struct ParticipantAnnouncement {
  bool is_departure = false;
  std::span<const std::uint8_t> user_data;  ///< part of the datagram; empty if there is none
};

/// Reads the announcement of the participant that has sent the datagram (RTPS 2.2, 8.5.3). `is_plain` becomes
/// false if the datagram is malformed or speaks for another participant than its sender, so that it has to be
/// refused. nullopt: the datagram announces nobody.
[[nodiscard]] std::optional<ParticipantAnnouncement> participant_announcement(
    std::span<const std::uint8_t> datagram, bool& is_plain);

/// Copies a datagram without its encrypted time stamp into `copy`; false if it has none before its message.
/// Fast DDS encrypts the time stamp as a submessage of its own (DDS Security 1.1, 9.5.2), and derives a key
/// for each, which takes as long as the message itself. Nobody reads it: messages have time stamps in their
/// headers.
[[nodiscard]] bool copy_without_timestamp(std::span<const std::uint8_t> datagram, Datagram& copy);

/// The datagram with which a participant would announce that it leaves (RTPS 2.2, 8.5.3: it disposes its
/// participant data). Passed to Fast DDS, it makes Fast DDS forget the participant.
Datagram departure_of(const ParticipantId& participant);

/// A presence announcement: an RTPS datagram with a vendor-specific submessage, which other software skips.
Datagram presence_datagram(const ParticipantId& sender, std::span<const PresenceNotice> notices);

/// The notices of a presence announcement; nullopt if the datagram is none. The datagram is untrusted.
[[nodiscard]] std::optional<std::vector<PresenceNotice>> presence_notices(
    std::span<const std::uint8_t> datagram);

}  // namespace sidestep
