// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "common/messaging/dds/presence.hpp"

namespace sidestep {

/// An RTPS datagram has a header and then submessages. A submessage has a header of its kind, its flags, and
/// its length in two bytes, which are little-endian if a flag says so (RTPS 2.2, 8.3.3 and 9.4).
inline constexpr std::size_t kDatagramHeaderSize = 8 + sizeof(ParticipantId);
inline constexpr std::size_t kSubmessageHeaderSize = 4;
inline constexpr std::uint8_t kLittleEndianFlag = 1;

/// Defined in RTPS 2.2, 9.4.5.1.1; the encrypted kinds in DDS Security 1.1, 7.3.6. Vendors may use 0x80 to
/// 0xff.
enum SubmessageKind : std::uint8_t {
  kPadSubmessage = 0x01,
  kAckNackSubmessage = 0x06,
  kHeartbeatSubmessage = 0x07,
  kGapSubmessage = 0x08,
  kTimestampSubmessage = 0x09,
  kSourceSubmessage = 0x0c,
  kDestinationSubmessage = 0x0e,
  kDataSubmessage = 0x15,
  kDataPartSubmessage = 0x16,
  kEncryptedBodySubmessage = 0x30,
  kEncryptedPrefixSubmessage = 0x31,
  kEncryptedPostfixSubmessage = 0x32,
  kStatisticsSubmessage = 0x80,  ///< used by Fast DDS
  kPresenceSubmessage = 0xf0,    ///< see presence_datagram()
};

}  // namespace sidestep
