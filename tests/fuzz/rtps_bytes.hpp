// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>

#include "common/messaging/dds/presence.hpp"
#include "tests/fuzz/fuzz_target.hpp"

/// Datagrams of RTPS as Fast DDS sends them, all little-endian (RTPS 2.2, 9.4).
namespace sidestep::fuzz::rtps {

Bytes datagram(const ParticipantId& sender, std::initializer_list<Bytes> submessages);

Bytes timestamp();
Bytes destination();
/// DATA of the writer that announces endpoints, with a payload.
Bytes data();
/// DATA of the writer that announces participants, with the participant's GUID and user data.
Bytes announcement(const ParticipantId& participant, const Bytes& user_data);
/// The first message of a handshake.
Bytes handshake();
Bytes acknowledgement(std::uint32_t bits, std::size_t words);
Bytes gap();
Bytes heartbeat();
/// Prefix, body and postfix of an encrypted submessage of `stated` bytes, padded to `present` bytes.
Bytes encrypted(std::uint32_t stated, std::size_t present);
/// The statistics submessage that Fast DDS appends to each datagram.
Bytes statistics();

}  // namespace sidestep::fuzz::rtps
