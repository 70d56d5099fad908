// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/datagram_check.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>

#include "common/messaging/dds/datagram_format.hpp"
#include "common/messaging/dds/handshake_check.hpp"
#include "common/messaging/dds/number_reader.hpp"
#include "fast_dds/plain_discovery.hpp"

namespace sidestep {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kStatisticsSize = 56;
/// Upper bound of the sequence numbers of a process's discovery messages, which count its own endpoints. Fast
/// DDS 2.9.1 iterates over all numbers below the one in a heartbeat or a gap.
constexpr std::int64_t kMaxPlainNumber = 1 << 15;
/// Entity ids of handshake messages (DDS Security 1.1, 7.4.3), whose sequence numbers count participants.
constexpr std::uint32_t kHandshakeWriter = 0x000201c3, kHandshakeReader = 0x000201c4;

/// Entity ids of the endpoints for protected liveliness (DDS Security 1.1, 7.4.3). Fast DDS creates them for
/// every participant with keys, but governance does not protect liveliness, so this writer has no messages.
/// Its readers ask for a heartbeat several times a second until one arrives.
constexpr std::uint32_t kSilentWriter = 0xff0200c2, kSilentReader = 0xff0200c7;

enum class WriterKind : std::uint8_t { kRefused, kDiscovery, kHandshake, kSilent };

/// Removes the ids of reader and writer from the front. Returns the kind of the writer, or kRefused if its
/// messages must be encrypted or the reader is not one of its readers. The reader may be unspecified, except
/// for the silent writer.
WriterKind read_entity_ids(NumberReader& reader) {
  const std::uint32_t to = reader.identifier(), from = reader.identifier();
  if (!reader.is_valid()) return WriterKind::kRefused;
  if (from == kSilentWriter) return to == kSilentReader ? WriterKind::kSilent : WriterKind::kRefused;
  if (from == kHandshakeWriter)
    return to == 0 || to == kHandshakeReader ? WriterKind::kHandshake : WriterKind::kRefused;
  const auto known = std::ranges::find(fast_dds::kPlainDiscovery, from, &fast_dds::DiscoveryPair::writer);
  if (known == fast_dds::kPlainDiscovery.end()) return WriterKind::kRefused;
  return to == 0 || to == known->reader ? WriterKind::kDiscovery : WriterKind::kRefused;
}

struct Submessage {
  std::uint8_t kind = 0, flags = 0;
  Bytes body;
};

/// Removes a submessage from the front. nullopt if it is truncated, or so long that its length is not stated.
std::optional<Submessage> read_submessage(Bytes& left) {
  if (left.size() < kSubmessageHeaderSize) return std::nullopt;
  Submessage result{left[0], left[1], {}};
  NumberReader reader(left.subspan(2), (result.flags & kLittleEndianFlag) != 0);
  const std::uint32_t size = reader.number(2);
  if (size > left.size() - kSubmessageHeaderSize || size == 0 || size % 4 != 0) return std::nullopt;
  result.body = left.subspan(kSubmessageHeaderSize, size);
  left = left.subspan(kSubmessageHeaderSize + size);
  return result;
}

bool is_valid_data(NumberReader& reader, std::uint8_t flags) {
  constexpr std::uint8_t kHasInlineQos = 2, kHasPayload = 4, kHasKey = 8;
  constexpr std::uint32_t kBytesToInlineQos = 16;
  const bool has_payload = (flags & kHasPayload) != 0, has_key = (flags & kHasKey) != 0;
  reader.number(2);
  if (reader.number(2) != kBytesToInlineQos || (has_payload && has_key)) return false;
  const WriterKind writer = read_entity_ids(reader);
  const bool is_handshake = writer == WriterKind::kHandshake;
  if (!is_handshake && writer != WriterKind::kDiscovery) return false;
  reader.sequence_number(1, is_handshake ? std::numeric_limits<std::int64_t>::max() : kMaxPlainNumber);
  if ((flags & kHasInlineQos) != 0) reader.skip_parameters();
  if (!reader.is_valid() || (reader.left() > 0) != (has_payload || has_key)) return false;
  return !is_handshake || (has_payload && is_handshake_message(reader.take(reader.left())));
}

/// Whether a submessage contains exactly the fields of its kind, with numbers within bounds.
bool is_valid_content(const Submessage& submessage) {
  NumberReader reader(submessage.body, (submessage.flags & kLittleEndianFlag) != 0);
  if (submessage.kind == kDataSubmessage) return is_valid_data(reader, submessage.flags);
  if (submessage.kind == kTimestampSubmessage) return submessage.body.size() == 8;
  if (submessage.kind == kDestinationSubmessage) return submessage.body.size() == sizeof(ParticipantId);
  const WriterKind writer = read_entity_ids(reader);
  const bool is_silent = writer == WriterKind::kSilent;
  if (!is_silent && writer != WriterKind::kDiscovery) return false;
  switch (submessage.kind) {
    case kAckNackSubmessage:
      // A reader of the silent writer has no message, and asks for none.
      reader.sequence_number(0, is_silent ? 2 : kMaxPlainNumber);
      if (is_silent && reader.number(4) != 0) return false;
      if (!is_silent) reader.skip_bitmap();
      break;
    case kGapSubmessage:
      if (is_silent) return false;
      reader.sequence_number(1, kMaxPlainNumber);
      reader.sequence_number(1, kMaxPlainNumber);
      reader.skip_bitmap();
      return reader.is_at_end();
    case kHeartbeatSubmessage: {
      const std::int64_t first = reader.sequence_number(1, is_silent ? 2 : kMaxPlainNumber),
                         last = reader.sequence_number(0, is_silent ? 1 : kMaxPlainNumber);
      if (last < first - 1) return false;
      break;
    }
    default:
      return false;
  }
  reader.number(4);  // number of times that the message was sent
  return reader.is_at_end();
}

/// Skips an encrypted submessage: its prefix, body and postfix. False if one is missing, or its size differs
/// from the stated one.
bool skip_encrypted(const Submessage& prefix, Bytes& left) {
  // Prefix: transformation, key, session and counter. Postfix: an authentication code of 16 bytes, and
  // none for individual receivers.
  constexpr std::size_t kPrefixSize = 20, kPostfixSize = 20, kCodeSize = 16;
  const auto body = read_submessage(left), postfix = read_submessage(left);
  if (!body || body->kind != kEncryptedBodySubmessage || !postfix ||
      postfix->kind != kEncryptedPostfixSubmessage)
    return false;
  NumberReader size(body->body, false);
  const std::uint32_t content = size.number(4);
  const bool has_codes =
      !std::ranges::all_of(postfix->body.subspan(std::min(postfix->body.size(), kCodeSize)),
                           [](std::uint8_t byte) { return byte == 0; });
  return prefix.body.size() == kPrefixSize && postfix->body.size() == kPostfixSize && !has_codes &&
         size.is_valid() && content > 0 && content <= size.left() && size.left() < content + 4;
}

bool is_statistics(const Submessage& submessage) {
  return submessage.kind == kStatisticsSubmessage && submessage.body.size() == kStatisticsSize;
}

}  // namespace

Bytes checked_datagram(Bytes datagram) {
  if (datagram.size() <= kDatagramHeaderSize) return {};
  Bytes left = datagram.subspan(kDatagramHeaderSize);
  while (!left.empty()) {
    const std::size_t begin = datagram.size() - left.size();
    const auto submessage = read_submessage(left);
    if (!submessage) return {};
    if (submessage->kind == kStatisticsSubmessage)
      return is_statistics(*submessage) && left.empty() && begin > kDatagramHeaderSize ? datagram.first(begin)
                                                                                       : Bytes();
    if (submessage->kind == kEncryptedPrefixSubmessage ? !skip_encrypted(*submessage, left)
                                                       : !is_valid_content(*submessage))
      return {};
  }
  return datagram;
}

Bytes without_statistics(Bytes datagram) {
  std::size_t begin = kDatagramHeaderSize;
  // As Fast DDS does: a size of 0 means that the submessage is the last one.
  while (begin + kSubmessageHeaderSize <= datagram.size()) {
    const std::uint8_t kind = datagram[begin];
    NumberReader reader(datagram.subspan(begin + 2), (datagram[begin + 1] & kLittleEndianFlag) != 0);
    const std::size_t size = reader.number(2), end = begin + kSubmessageHeaderSize + (size + 3) / 4 * 4;
    if (kind == kStatisticsSubmessage)
      return size == kStatisticsSize && end == datagram.size() ? datagram.first(begin) : Bytes();
    if (size == 0 && kind != kTimestampSubmessage && kind != kPadSubmessage) break;
    begin = end;
  }
  return datagram;
}

}  // namespace sidestep
