// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/datagram.hpp"

#include <algorithm>
#include <array>
#include <concepts>
#include <cstring>

namespace sidestep {
namespace {

using Bytes = std::span<const std::uint8_t>;

// RTPS 2.2, 9.4.4: protocol, version, vendor, GUID prefix.
constexpr std::array<std::uint8_t, 8> kHeader{'R', 'T', 'P', 'S', 2, 2, 1, 15};
constexpr std::size_t kHeaderSize = kHeader.size() + sizeof(ParticipantId);
constexpr std::array<std::uint8_t, 4> kProtocol{'R', 'T', 'P', 'S'};

constexpr std::uint8_t kLittleEndian = 1;
constexpr std::size_t kSubmessageHeaderSize = 4;

// Vendors may use 0x80 to 0xff (RTPS 2.2, 9.4.5.1.1).
constexpr std::uint8_t kPresenceSubmessage = 0xf0;
constexpr std::array<std::uint8_t, 4> kPresenceMark{'S', 'i', 'd', '1'};
constexpr std::size_t kNoticeSize = sizeof(ParticipantId) + 4 + 8;

template <std::unsigned_integral Integer>
void append(Datagram& to, Integer value) {
  for (std::size_t i = 0; i < sizeof value; ++i) to.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

void append(Datagram& to, Bytes bytes) { to.insert(to.end(), bytes.begin(), bytes.end()); }

/// Removes an integer from the front. Precondition: there are enough bytes.
template <std::unsigned_integral Integer>
Integer take(Bytes& from) {
  Integer value = 0;
  for (std::size_t i = 0; i < sizeof value; ++i) value |= static_cast<Integer>(Integer{from[i]} << (8 * i));
  from = from.subspan(sizeof value);
  return value;
}

Datagram one_submessage(const ParticipantId& sender, std::uint8_t kind, std::uint8_t flags, Bytes body) {
  Datagram result(kHeader.begin(), kHeader.end());
  append(result, sender);
  append(result, std::array{kind, flags});
  append(result, static_cast<std::uint16_t>(body.size()));
  append(result, body);
  return result;
}

}  // namespace

std::optional<ParticipantId> sender_of(Bytes datagram) {
  if (datagram.size() < kHeaderSize) return std::nullopt;
  if (!std::equal(kProtocol.begin(), kProtocol.end(), datagram.begin())) return std::nullopt;
  ParticipantId result;
  std::memcpy(result.data(), datagram.data() + kHeader.size(), result.size());
  return result;
}

Datagram departure_of(const ParticipantId& participant) {
  constexpr std::uint8_t kData = 0x15, kHasInlineQos = 2;
  constexpr std::uint16_t kKeyHash = 0x70, kStatus = 0x71, kEnd = 1;
  constexpr std::array<std::uint8_t, 4> kReader{0, 1, 0, 0xc7}, kWriter{0, 1, 0, 0xc2},
      kParticipant{0, 0, 1, 0xc1}, kDisposedAndUnregistered{0, 0, 0, 3};
  constexpr std::uint16_t kBytesToInlineQos = 16;

  Datagram body;
  append(body, std::uint16_t{0});
  append(body, kBytesToInlineQos);
  append(body, kReader);
  append(body, kWriter);
  append(body, std::uint32_t{1});  // high half of the sequence number: higher than that of any announcement
  append(body, std::uint32_t{0});
  append(body, kKeyHash);
  append(body, static_cast<std::uint16_t>(participant.size() + kParticipant.size()));
  append(body, participant);
  append(body, kParticipant);
  append(body, kStatus);
  append(body, static_cast<std::uint16_t>(kDisposedAndUnregistered.size()));
  append(body, kDisposedAndUnregistered);
  append(body, kEnd);
  append(body, std::uint16_t{0});
  return one_submessage(participant, kData, kLittleEndian | kHasInlineQos, body);
}

Datagram presence_datagram(const ParticipantId& sender, std::span<const PresenceNotice> notices) {
  Datagram body;
  append(body, kPresenceMark);
  for (const PresenceNotice& notice : notices) {
    append(body, notice.whom);
    append(body, static_cast<std::uint32_t>(notice.kind));
    append(body, notice.number);
  }
  return one_submessage(sender, kPresenceSubmessage, kLittleEndian, body);
}

std::optional<std::vector<PresenceNotice>> presence_notices(Bytes datagram) {
  constexpr std::size_t kFixedSize = kHeaderSize + kSubmessageHeaderSize + kPresenceMark.size();
  if (datagram.size() < kFixedSize || datagram.size() > kFixedSize + Presence::kMaxNotices * kNoticeSize ||
      (datagram.size() - kFixedSize) % kNoticeSize != 0)
    return std::nullopt;
  const Bytes submessage = datagram.subspan(kHeaderSize);
  if (submessage[0] != kPresenceSubmessage || submessage[1] != kLittleEndian) return std::nullopt;
  Bytes left = submessage.subspan(2);
  if (take<std::uint16_t>(left) != left.size()) return std::nullopt;
  if (!std::equal(kPresenceMark.begin(), kPresenceMark.end(), left.begin())) return std::nullopt;
  left = left.subspan(kPresenceMark.size());
  std::vector<PresenceNotice> result;
  while (!left.empty()) {
    PresenceNotice& notice = result.emplace_back();
    std::memcpy(notice.whom.data(), left.data(), notice.whom.size());
    left = left.subspan(notice.whom.size());
    notice.kind = static_cast<PresenceNotice::Kind>(take<std::uint32_t>(left));
    if (notice.kind != PresenceNotice::Kind::kForgotten && notice.kind != PresenceNotice::Kind::kAgreed)
      return std::nullopt;
    notice.number = take<std::uint64_t>(left);
  }
  return result;
}

}  // namespace sidestep
