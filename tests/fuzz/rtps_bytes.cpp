// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/rtps_bytes.hpp"

#include <string>
#include <utility>
#include <vector>

#include "common/messaging/dds/datagram_format.hpp"

namespace sidestep::fuzz::rtps {
namespace {

/// Appends numbers of 2 and 4 bytes, zeros and bytes.
class Body {
 public:
  Body& u16(std::size_t value) { return number(value, 2); }
  Body& u32(std::size_t value) { return number(value, 4); }
  /// The high half comes first.
  Body& sequence_number(std::size_t value) { return u32(0).u32(value); }
  Body& zeros(std::size_t count) {
    bytes_.resize(bytes_.size() + count);
    return *this;
  }
  Body& raw(View bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return *this;
  }
  const Bytes& bytes() const { return bytes_; }

 private:
  Body& number(std::size_t value, int size) {
    for (int i = 0; i < size; ++i) bytes_.push_back(static_cast<std::uint8_t>(value >> 8 * i));
    return *this;
  }
  Bytes bytes_;
};

Bytes submessage(std::uint8_t kind, const Body& body, std::uint8_t flags = kLittleEndianFlag) {
  const Bytes head{kind, flags};
  return Body().raw(head).u16(body.bytes().size()).raw(body.bytes()).bytes();
}

constexpr std::size_t kParticipantReader = 0xc7000100, kParticipantWriter = 0xc2000100,
                      kEndpointWriter = 0xc2030000;

Body data_header(std::size_t reader, std::size_t writer) {
  constexpr std::size_t kBytesToInlineQos = 16;
  return Body().u16(0).u16(kBytesToInlineQos).u32(reader).u32(writer).sequence_number(7);
}

/// Entity ids of a submessage to any reader, from the writer that announces endpoints.
Body discovery_entities() { return Body().u32(0).u32(kEndpointWriter); }

}  // namespace

Bytes datagram(const ParticipantId& sender, std::initializer_list<Bytes> submessages) {
  const Bytes head{'R', 'T', 'P', 'S', 2, 2, 1, 15};
  Body result = Body().raw(head).raw(sender);
  for (const Bytes& bytes : submessages) result.raw(bytes);
  return result.bytes();
}

Bytes timestamp() { return submessage(kTimestampSubmessage, Body().u32(1'800'000'000).u32(0)); }
Bytes destination() { return submessage(kDestinationSubmessage, Body().zeros(12)); }

Bytes data() {
  constexpr std::uint8_t kHasPayload = 4;
  return submessage(kDataSubmessage, data_header(0, kEndpointWriter).u32(0x100).zeros(24),
                    kLittleEndianFlag | kHasPayload);
}

Bytes announcement(const ParticipantId& participant, const Bytes& user_data) {
  constexpr std::uint8_t kHasPayload = 4;
  constexpr std::size_t kLittleEndianList = 0x0300, kGuid = 0x50, kUserData = 0x2c, kEnd = 1;
  const std::size_t padding = (4 - user_data.size() % 4) % 4;
  Body body = data_header(kParticipantReader, kParticipantWriter).u32(kLittleEndianList);
  body.u16(kGuid).u16(16).raw(participant).u32(0xc1010000);
  body.u16(kUserData).u16(4 + user_data.size() + padding).u32(user_data.size()).raw(user_data).zeros(padding);
  return submessage(kDataSubmessage, body.u16(kEnd).u16(0), kLittleEndianFlag | kHasPayload);
}

Bytes handshake() {
  constexpr std::uint8_t kHasPayload = 4;
  constexpr std::size_t kLittleEndian = 0x0100, kHandshakeWriter = 0xc3010200;
  const auto counted = [](Body& body, const std::string& content) {
    body.u32(content.size()).raw(View(reinterpret_cast<const std::uint8_t*>(content.data()), content.size()));
    body.zeros((4 - content.size() % 4) % 4);
  };
  Body body = data_header(0, kHandshakeWriter).u32(kLittleEndian).zeros(96);
  counted(body, std::string("dds.sec.auth") + '\0');
  body.u32(1);
  counted(body, std::string("DDS:Auth:PKI-DH:1.0+Req") + '\0');
  const std::vector<std::pair<std::string, std::string>> properties{
      {"c.id", "certificate"},
      {"c.pdata", std::string({0, 0x15, 0, 4, 2, 3, 0, 0, 0, 1, 0, 0})},
      {"hash_c1", std::string(32, 'x')},
      {"dh1", std::string(256, 'x')},
      {"challenge1", std::string(32, 'x')}};
  body.u32(0).u32(properties.size());
  for (const auto& [name, value] : properties) {
    counted(body, name + '\0');
    counted(body, value);
  }
  return submessage(kDataSubmessage, body, kLittleEndianFlag | kHasPayload);
}

Bytes acknowledgement(std::uint32_t bits, std::size_t words) {
  return submessage(kAckNackSubmessage,
                    discovery_entities().sequence_number(1).u32(bits).zeros(4 * words).u32(1));
}
Bytes gap() {
  return submessage(kGapSubmessage, discovery_entities().sequence_number(3).sequence_number(4).u32(0));
}
Bytes heartbeat() {
  return submessage(kHeartbeatSubmessage, discovery_entities().sequence_number(1).sequence_number(7).u32(1));
}
Bytes encrypted(std::uint32_t stated, std::size_t present) {
  const Bytes size{static_cast<std::uint8_t>(stated >> 24), static_cast<std::uint8_t>(stated >> 16),
                   static_cast<std::uint8_t>(stated >> 8), static_cast<std::uint8_t>(stated)};
  return Body()
      .raw(submessage(kEncryptedPrefixSubmessage, Body().zeros(20)))
      .raw(submessage(kEncryptedBodySubmessage, Body().raw(size).zeros(present)))
      .raw(submessage(kEncryptedPostfixSubmessage, Body().zeros(20)))
      .bytes();
}

Bytes statistics() { return submessage(kStatisticsSubmessage, Body().zeros(56)); }

}  // namespace sidestep::fuzz::rtps
