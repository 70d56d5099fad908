// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/messaging/dds/presence.hpp"

namespace sidestep {

using Datagram = std::vector<std::uint8_t>;

/// The sender of an RTPS datagram, as stated in its header; nullopt if it has no RTPS header.
[[nodiscard]] std::optional<ParticipantId> sender_of(std::span<const std::uint8_t> datagram);

/// The content of an untrusted datagram that concerns the discovery of participants.
struct ParticipantAnnouncement {
  bool is_departure = false;
  std::span<const std::uint8_t> user_data;  ///< part of the datagram; empty if there is none
};

/// Reads the announcement in a datagram of its sender (RTPS 2.2, 8.5.3). `is_plain` becomes false if the
/// datagram is malformed or speaks for a participant other than its sender; it must then be refused. nullopt
/// if the datagram announces no participant.
[[nodiscard]] std::optional<ParticipantAnnouncement> participant_announcement(
    std::span<const std::uint8_t> datagram, bool& is_plain);

/// Copies a datagram into `copy` without its encrypted time stamp. False if no time stamp precedes its
/// message. Fast DDS encrypts the time stamp as a separate submessage (DDS Security 1.1, 9.5.2) and derives a
/// key for it, which takes as long as for the message itself. No process reads this time stamp: our messages
/// have time stamps in their headers.
[[nodiscard]] bool copy_without_timestamp(std::span<const std::uint8_t> datagram, Datagram& copy);

/// The datagram with which a participant would announce its departure (RTPS 2.2, 8.5.3: it disposes its
/// participant data). Fast DDS forgets the participant when it receives this datagram.
Datagram departure_of(const ParticipantId& participant);

/// A presence announcement: an RTPS datagram with a vendor-specific submessage, which other software skips.
Datagram presence_datagram(const ParticipantId& sender, std::span<const PresenceNotice> notices);

/// The notices in an untrusted presence announcement; nullopt if the datagram is not one.
[[nodiscard]] std::optional<std::vector<PresenceNotice>> presence_notices(
    std::span<const std::uint8_t> datagram);

}  // namespace sidestep
