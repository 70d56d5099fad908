// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/datagram.hpp"

#include <algorithm>
#include <array>
#include <concepts>
#include <cstring>

#include "common/messaging/dds/datagram_format.hpp"

namespace sidestep {
namespace {

using Bytes = std::span<const std::uint8_t>;

// RTPS 2.2, 9.4.4: protocol, version, vendor, GUID prefix.
constexpr std::array<std::uint8_t, 8> kHeader{'R', 'T', 'P', 'S', 2, 2, 1, 15};
static_assert(kHeader.size() + sizeof(ParticipantId) == kDatagramHeaderSize);
constexpr std::array<std::uint8_t, 4> kProtocol{'R', 'T', 'P', 'S'};

using EntityId = std::array<std::uint8_t, 4>;
/// Writers that announce participants: the first writer to all participants, the second to authenticated ones
/// (DDS Security 1.1, 7.4.4).
constexpr std::array<EntityId, 2> kParticipantWriters{{{0, 1, 0, 0xc2}, {0xff, 1, 1, 0xc2}}};
constexpr std::size_t kDataHeaderSize = 20;

constexpr std::array<std::uint8_t, 4> kPresenceMark{'S', 'i', 'd', '1'};
constexpr std::size_t kNoticeSize = sizeof(ParticipantId) + 4 + 8;

template <std::unsigned_integral Integer>
void append(Datagram& to, Integer value) {
  for (std::size_t i = 0; i < sizeof value; ++i) to.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

void append(Datagram& to, Bytes bytes) { to.insert(to.end(), bytes.begin(), bytes.end()); }

/// Removes an integer from the front and returns it. Precondition: there are enough bytes.
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

/// Calls `use(id, value)` for each parameter of a parameter list (RTPS 2.2, 9.4.2.11), and removes the list
/// from `bytes`. False if the list is malformed.
template <typename Use>
bool for_each_parameter(Bytes& bytes, bool is_little_endian, Use use) {
  constexpr std::uint16_t kEnd = 1;
  const auto number = [&](std::size_t at) {
    return static_cast<std::uint16_t>(is_little_endian ? bytes[at] | bytes[at + 1] << 8
                                                       : bytes[at] << 8 | bytes[at + 1]);
  };
  while (bytes.size() >= 4) {
    const std::uint16_t id = number(0);
    const std::size_t size = number(2);
    bytes = bytes.subspan(4);
    if (id == kEnd) return true;
    if (size > bytes.size()) return false;
    use(id, bytes.first(size));
    bytes = bytes.subspan(size);
  }
  return false;
}

/// Reads an announcement from `body`, a DATA submessage of the writer that announces participants (RTPS 2.2,
/// 9.4.5.3). False if it is malformed or about a participant other than the sender.
bool read_announcement(Bytes body, std::uint8_t flags, Bytes sender, ParticipantAnnouncement& result) {
  constexpr std::uint8_t kHasInlineQos = 2, kHasPayload = 4;
  constexpr std::uint16_t kKeyHash = 0x70, kGuid = 0x50, kUserData = 0x2c;
  bool is_of_sender = true;
  const auto check_guid = [&](Bytes guid) {
    is_of_sender =
        is_of_sender && guid.size() >= sender.size() && std::ranges::equal(guid.first(sender.size()), sender);
  };
  body = body.subspan(kDataHeaderSize);
  if ((flags & kHasInlineQos) != 0 &&
      !for_each_parameter(body, (flags & kLittleEndianFlag) != 0, [&](std::uint16_t id, Bytes value) {
        if (id == kKeyHash) check_guid(value);
      }))
    return false;
  result.is_departure = (flags & kHasPayload) == 0;
  if (result.is_departure) return is_of_sender;
  constexpr std::size_t kEncapsulationSize = 4;
  constexpr std::uint8_t kBigEndianList = 2, kLittleEndianList = 3;
  if (body.size() < kEncapsulationSize || body[0] != 0 ||
      (body[1] != kBigEndianList && body[1] != kLittleEndianList))
    return false;
  const bool is_little_endian = body[1] == kLittleEndianList;
  body = body.subspan(kEncapsulationSize);
  const bool is_valid = for_each_parameter(body, is_little_endian, [&](std::uint16_t id, Bytes value) {
    if (id == kGuid) check_guid(value);
    if (id != kUserData || value.size() < 4) return;
    const std::size_t size = is_little_endian ? value[0] | value[1] << 8 : value[2] << 8 | value[3];
    if (size <= value.size() - 4) result.user_data = value.subspan(4, size);
  });
  return is_valid && is_of_sender;
}

}  // namespace

std::optional<ParticipantId> sender_of(Bytes datagram) {
  if (datagram.size() < kDatagramHeaderSize) return std::nullopt;
  if (!std::equal(kProtocol.begin(), kProtocol.end(), datagram.begin())) return std::nullopt;
  ParticipantId result;
  std::memcpy(result.data(), datagram.data() + kHeader.size(), result.size());
  return result;
}

std::optional<ParticipantAnnouncement> participant_announcement(Bytes datagram, bool& is_plain) {
  is_plain = false;
  if (datagram.size() < kDatagramHeaderSize) return std::nullopt;
  const Bytes sender = datagram.subspan(kHeader.size(), sizeof(ParticipantId));
  std::optional<ParticipantAnnouncement> result;
  for (Bytes left = datagram.subspan(kDatagramHeaderSize); !left.empty();) {
    if (left.size() < kSubmessageHeaderSize) return std::nullopt;
    const std::uint8_t kind = left[0], flags = left[1];
    const bool is_little_endian = (flags & kLittleEndianFlag) != 0;
    std::size_t size = is_little_endian ? left[2] | left[3] << 8 : left[2] << 8 | left[3];
    left = left.subspan(kSubmessageHeaderSize);
    if (size == 0 && kind != kTimestampSubmessage && kind != kPadSubmessage)
      size = left.size();  // a size of 0 marks the last submessage
    if (size > left.size() || kind == kSourceSubmessage) return std::nullopt;
    const Bytes body = left.first(size);
    left = left.subspan(size);
    if ((kind != kDataSubmessage && kind != kDataPartSubmessage) || body.size() < kDataHeaderSize) continue;
    const Bytes writer = body.subspan(8, 4);
    const auto announces = [&](const EntityId& id) { return std::ranges::equal(writer, id); };
    if (std::ranges::none_of(kParticipantWriters, announces)) continue;
    if (kind == kDataPartSubmessage) return std::nullopt;  // announcements are too small to be sent in parts
    ParticipantAnnouncement found;
    if (!read_announcement(body, flags, sender, found)) return std::nullopt;
    result = found;
  }
  is_plain = true;
  return result;
}

bool copy_without_timestamp(Bytes datagram, Datagram& copy) {
  constexpr std::size_t kPlainTimestampSize = 12;  // size including the header
  std::size_t begin = kDatagramHeaderSize;
  const auto size_at = [&](std::size_t at) -> std::size_t {
    const bool is_little_endian = (datagram[at + 1] & kLittleEndianFlag) != 0;
    return is_little_endian ? datagram[at + 2] | datagram[at + 3] << 8
                            : datagram[at + 2] << 8 | datagram[at + 3];
  };
  const auto has = [&](std::size_t at, std::uint8_t kind) {
    return datagram.size() >= at + kSubmessageHeaderSize && datagram[at] == kind &&
           datagram.size() - at - kSubmessageHeaderSize >= size_at(at);
  };
  const auto next = [&](std::size_t at) { return at + kSubmessageHeaderSize + size_at(at); };
  if (has(begin, kDestinationSubmessage)) begin = next(begin);
  if (!has(begin, kEncryptedPrefixSubmessage)) return false;
  const std::size_t body = next(begin);
  // The body is the encrypted submessage, preceded by its size.
  if (!has(body, kEncryptedBodySubmessage) || size_at(body) != kPlainTimestampSize + 4) return false;
  const std::size_t postfix = next(body);
  if (!has(postfix, kEncryptedPostfixSubmessage) || !has(next(postfix), kEncryptedPrefixSubmessage))
    return false;
  copy.assign(datagram.begin(), datagram.begin() + static_cast<std::ptrdiff_t>(begin));
  append(copy, datagram.subspan(next(postfix)));
  return true;
}

Datagram departure_of(const ParticipantId& participant) {
  constexpr std::uint8_t kHasInlineQos = 2;
  constexpr std::uint16_t kKeyHash = 0x70, kStatus = 0x71, kEnd = 1;
  constexpr std::array<std::uint8_t, 4> kReader{0, 1, 0, 0xc7}, kWriter{0, 1, 0, 0xc2},
      kParticipant{0, 0, 1, 0xc1}, kDisposedAndUnregistered{0, 0, 0, 3};
  constexpr std::uint16_t kBytesToInlineQos = 16;

  Datagram body;
  append(body, std::uint16_t{0});
  append(body, kBytesToInlineQos);
  append(body, kReader);
  append(body, kWriter);
  append(body, std::uint32_t{1});  // high half of a sequence number that exceeds that of any announcement
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
  return one_submessage(participant, kDataSubmessage, kLittleEndianFlag | kHasInlineQos, body);
}

Datagram presence_datagram(const ParticipantId& sender, std::span<const PresenceNotice> notices) {
  Datagram body;
  append(body, kPresenceMark);
  for (const PresenceNotice& notice : notices) {
    append(body, notice.whom);
    append(body, static_cast<std::uint32_t>(notice.kind));
    append(body, notice.number);
  }
  return one_submessage(sender, kPresenceSubmessage, kLittleEndianFlag, body);
}

std::optional<std::vector<PresenceNotice>> presence_notices(Bytes datagram) {
  constexpr std::size_t kFixedSize = kDatagramHeaderSize + kSubmessageHeaderSize + kPresenceMark.size();
  if (datagram.size() < kFixedSize || datagram.size() > kFixedSize + Presence::kMaxNotices * kNoticeSize ||
      (datagram.size() - kFixedSize) % kNoticeSize != 0)
    return std::nullopt;
  const Bytes submessage = datagram.subspan(kDatagramHeaderSize);
  if (submessage[0] != kPresenceSubmessage || submessage[1] != kLittleEndianFlag) return std::nullopt;
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
