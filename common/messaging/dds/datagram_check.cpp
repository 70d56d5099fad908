// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/datagram_check.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "common/messaging/dds/datagram_format.hpp"

namespace sidestep {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kStatisticsSize = 56;
/// Above the numbers that a process gives to messages of discovery, which count its own endpoints. Fast DDS
/// 2.9.1 counts from number to number up to the one that a heartbeat or a gap states, without an end.
constexpr std::int64_t kMaxPlainNumber = 1 << 20;
/// Writes the messages of handshakes (DDS Security 1.1, 7.4.3), as many as there have been participants.
constexpr std::uint32_t kHandshakeWriter = 0x000201c3;

/// Reads numbers from the front of bytes. Once they do not suffice, everything is 0 and is_valid() false.
class NumberReader {
 public:
  NumberReader(Bytes bytes, bool is_little_endian) : left_(bytes), is_little_endian_(is_little_endian) {}

  bool is_valid() const { return is_valid_; }
  bool is_at_end() const { return is_valid_ && left_.empty(); }
  std::size_t left() const { return left_.size(); }

  Bytes take(std::size_t count) {
    is_valid_ = is_valid_ && count <= left_.size();
    const Bytes taken = left_.first(is_valid_ ? count : 0);
    left_ = left_.subspan(taken.size());
    return taken;
  }
  std::uint32_t number(std::size_t size) {
    std::uint32_t result = 0;
    const Bytes bytes = take(size);
    for (std::size_t i = 0; i < bytes.size(); ++i)
      result = result << 8 | bytes[is_little_endian_ ? bytes.size() - 1 - i : i];
    return result;
  }
  /// High half, low half.
  std::int64_t sequence_number() {
    const std::uint32_t high = number(4), low = number(4);
    return static_cast<std::int64_t>(std::uint64_t{high} << 32 | low);
  }
  /// One that is at least `min`, and below kMaxPlainNumber; else 0.
  std::int64_t plain_number(std::int64_t min) {
    const std::int64_t result = sequence_number();
    is_valid_ = is_valid_ && result >= min && result < kMaxPlainNumber;
    return is_valid_ ? result : 0;
  }
  /// Of the reader, which may be unknown, and of the writer: both serve discovery (RTPS 2.2, 9.3.1.2).
  std::uint32_t entities_of_discovery() {
    constexpr std::uint8_t kBuiltin = 0xc0;
    const Bytes reader = take(4), writer = take(4);
    if (!is_valid_) return 0;
    const bool is_reader_unknown = std::ranges::all_of(reader, [](std::uint8_t byte) { return byte == 0; });
    is_valid_ =
        (is_reader_unknown || (reader[3] & kBuiltin) == kBuiltin) && (writer[3] & kBuiltin) == kBuiltin;
    return std::uint32_t{writer[0]} << 24 | std::uint32_t{writer[1]} << 16 | std::uint32_t{writer[2]} << 8 |
           writer[3];
  }
  /// A count of bits, at most 256, and the words that hold them.
  void skip_bitmap() {
    constexpr std::uint32_t kMaxBits = 256;
    const std::uint32_t bits = number(4);
    is_valid_ = is_valid_ && bits <= kMaxBits;
    take((bits + 31) / 32 * 4);
  }
  /// Parameters until the one that ends the list (RTPS 2.2, 9.4.2.11).
  void skip_parameters() {
    constexpr std::uint32_t kEnd = 1;
    while (is_valid_) {
      const std::uint32_t id = number(2), size = number(2);
      if (id == kEnd) return;
      is_valid_ = is_valid_ && size % 4 == 0;
      take(size);
    }
  }

 private:
  Bytes left_;
  bool is_little_endian_;
  bool is_valid_ = true;
};

struct Submessage {
  std::uint8_t kind = 0, flags = 0;
  Bytes body;
};

/// Removes a submessage from the front. nullopt if it is cut off, or so long that its length is not stated.
std::optional<Submessage> take_submessage(Bytes& left) {
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
  if (reader.entities_of_discovery() == kHandshakeWriter) {
    if (reader.sequence_number() < 1) return false;
  } else {
    reader.plain_number(1);
  }
  if ((flags & kHasInlineQos) != 0) reader.skip_parameters();
  return reader.is_valid() && (reader.left() > 0) == (has_payload || has_key);
}

/// Numbers in the order in which they are sent, and nothing after them.
bool is_valid_content(const Submessage& submessage) {
  NumberReader reader(submessage.body, (submessage.flags & kLittleEndianFlag) != 0);
  switch (submessage.kind) {
    case kDataSubmessage:
      return is_valid_data(reader, submessage.flags);
    case kAckNackSubmessage:
      reader.entities_of_discovery();
      reader.plain_number(0);
      reader.skip_bitmap();
      break;
    case kGapSubmessage:
      reader.entities_of_discovery();
      reader.plain_number(1);
      reader.plain_number(1);
      reader.skip_bitmap();
      return reader.is_at_end();
    case kHeartbeatSubmessage: {
      reader.entities_of_discovery();
      const std::int64_t first = reader.plain_number(1), last = reader.plain_number(0);
      if (last < first - 1) return false;
      break;
    }
    case kTimestampSubmessage:
      return submessage.body.size() == 8;
    case kDestinationSubmessage:
      return submessage.body.size() == sizeof(ParticipantId);
    default:
      return false;
  }
  reader.number(4);  // how often this has been said
  return reader.is_at_end();
}

/// Passes over an encrypted submessage: what it begins with, its content, and its code. False if one is
/// missing, or has another size than it states.
bool skip_encrypted(const Submessage& prefix, Bytes& left) {
  // Transformation, key, session, counter; code of 16 bytes, and no codes for single receivers.
  constexpr std::size_t kPrefixSize = 20, kPostfixSize = 20, kCodeSize = 16;
  const auto body = take_submessage(left), postfix = take_submessage(left);
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
    const auto submessage = take_submessage(left);
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
