// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/handshake_check.hpp"

#include <limits>
#include <string>
#include <vector>

#include "common/messaging/dds/datagram_check.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::handshake_check_test {

using Bytes = std::vector<std::uint8_t>;

/// A payload in CDR, little-endian.
struct Payload {
  Bytes bytes{0, 1, 0, 0};

  Payload& u32(std::uint32_t value) {
    for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> 8 * i));
    return *this;
  }
  Payload& zeros(std::size_t count) {
    bytes.resize(bytes.size() + count);
    return *this;
  }
  Payload& octets(const Bytes& value) {
    u32(static_cast<std::uint32_t>(value.size()));
    bytes.insert(bytes.end(), value.begin(), value.end());
    return zeros((4 - value.size() % 4) % 4);
  }
  Payload& text(const std::string& value) {
    Bytes with_end(value.begin(), value.end());
    with_end.push_back(0);
    return octets(with_end);
  }
};

struct Property {
  std::string name;
  Bytes value;
};

/// Participant data in network byte order: one parameter of four bytes, and the end marker.
const Bytes kParticipantData{0, 0x15, 0, 4, 2, 3, 0, 0, 0, 1, 0, 0};

std::vector<Property> request() {
  return {{"c.id", Bytes(566, 'x')},        {"c.perm", Bytes(3081, 'x')}, {"c.pdata", kParticipantData},
          {"c.dsign_algo", Bytes(12, 'x')}, {"hash_c1", Bytes(32)},       {"dh1", Bytes(256)},
          {"challenge1", Bytes(32)}};
}

Payload head(const std::string& message_class = "dds.sec.auth", std::uint32_t tokens = 1,
             const std::string& token = "DDS:Auth:PKI-DH:1.0+Req") {
  return Payload().zeros(96).text(message_class).u32(tokens).text(token);
}

Bytes message(const std::vector<Property>& properties, Payload payload = head()) {
  payload.u32(0).u32(static_cast<std::uint32_t>(properties.size()));
  for (const Property& property : properties) payload.text(property.name).octets(property.value);
  return payload.bytes;
}

TEST_CASE("handshake messages pass in either byte order") {
  CHECK(is_handshake_message(message(request())));
  CHECK(is_handshake_message(message({{"hash_c2", Bytes(32)}, {"signature", Bytes(71)}})));
  // A message without properties in the other byte order: all numbers are swapped by hand.
  Bytes big{0, 0, 0, 0};
  big.resize(4 + 96);
  const auto number = [&big](std::uint32_t value) {
    for (int i = 3; i >= 0; --i) big.push_back(static_cast<std::uint8_t>(value >> 8 * i));
  };
  const auto text = [&](const std::string& value) {
    number(static_cast<std::uint32_t>(value.size() + 1));
    big.insert(big.end(), value.begin(), value.end());
    big.resize((big.size() + 4) / 4 * 4);
  };
  text("dds.sec.auth");
  number(1);
  text("DDS:Auth:PKI-DH:1.0+Final");
  number(0);
  number(1);
  text("dh1");
  number(1);
  big.insert(big.end(), {7, 0, 0, 0});
  CHECK(is_handshake_message(big));
}

TEST_CASE("a handshake message with an unknown token or name or a wrong size is refused") {
  const auto with = [](std::size_t index, const Property& property) {
    std::vector<Property> result = request();
    result[index] = property;
    return message(result);
  };
  CHECK_FALSE(is_handshake_message({}));
  CHECK_FALSE(is_handshake_message(message({})));
  CHECK_FALSE(is_handshake_message(message(request(), head("dds.sec.other"))));
  for (const std::uint32_t tokens : {0u, 2u, 0xffffffffu})
    CHECK_FALSE(is_handshake_message(message(request(), head("dds.sec.auth", tokens))));
  CHECK_FALSE(is_handshake_message(message(request(), head("dds.sec.auth", 1, "DDS:Auth:PKI-DH:1.0+Other"))));
  CHECK_FALSE(is_handshake_message(with(0, {"c.other", Bytes(4)})));
  CHECK_FALSE(is_handshake_message(with(0, {"c.id", {}})));
  CHECK_FALSE(is_handshake_message(with(4, {"hash_c1", Bytes(31)})));
  CHECK_FALSE(is_handshake_message(with(4, {"hash_c1", Bytes(33)})));
  CHECK_FALSE(is_handshake_message(with(5, {"dh1", Bytes(1025)})));
  CHECK_FALSE(is_handshake_message(with(2, {"c.pdata", {0, 0x15, 0, 8, 2, 3, 0, 0, 0, 1, 0, 0}})));
  CHECK_FALSE(is_handshake_message(with(2, {"c.pdata", {0, 0x15, 0, 4, 2, 3, 0, 0}})));
  CHECK_FALSE(is_handshake_message(message(std::vector<Property>(14, {"dh1", Bytes(4)}))));
}

TEST_CASE("a handshake message that states a size beyond its end never passes") {
  const Bytes whole = message(request());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    CAPTURE(size);
    CHECK_FALSE(is_handshake_message(std::span(whole).first(size)));
  }
  for (const std::size_t more : {1, 4, 64}) {
    CAPTURE(more);
    Bytes longer = whole;
    longer.resize(whole.size() + more);
    CHECK_FALSE(is_handshake_message(longer));
  }
  const std::uint64_t seed = 11;
  CAPTURE(seed);
  Rng rng(seed);
  int passed = 0;
  for (std::size_t at = 4 + 96; at + 4 <= whole.size(); at += 4) {
    for (const std::uint32_t value : {0x40000000u, 0x80000000u, 0xfffffff0u, 0xfffffffdu, 0xffffffffu}) {
      Bytes changed = whole;
      for (std::size_t i = 0; i < 4; ++i) changed[at + i] = static_cast<std::uint8_t>(value >> 8 * i);
      passed += is_handshake_message(changed);
    }
  }
  // A changed message that passes differs in the content of a document, hash or number, but in no size.
  CHECK(passed > 0);
  CHECK(passed < static_cast<int>(5 * whole.size() / 4));
}

TEST_CASE("only complete handshake messages are passed on, with any sequence number") {
  const auto datagram_with = [](const Bytes& payload, std::uint32_t high) {
    Bytes result{'R', 'T', 'P', 'S', 2, 2, 1, 15};
    result.resize(20);
    const std::size_t size = 20 + payload.size();
    result.insert(result.end(),
                  {0x15, 5, static_cast<std::uint8_t>(size), static_cast<std::uint8_t>(size >> 8), 0, 0, 16,
                   0, 0, 0, 0, 0, 0, 2, 1, 0xc3});
    for (const std::uint32_t half : {high, 5u})
      for (int i = 0; i < 4; ++i) result.push_back(static_cast<std::uint8_t>(half >> 8 * i));
    result.insert(result.end(), payload.begin(), payload.end());
    return result;
  };
  const Bytes genuine = message(request());
  CHECK_FALSE(checked_datagram(datagram_with(genuine, 0)).empty());
  CHECK_FALSE(checked_datagram(datagram_with(genuine, 1)).empty());
  Bytes larger = genuine;
  larger[4 + 96] = 0xff;
  CHECK(checked_datagram(datagram_with(larger, 0)).empty());
  CHECK(checked_datagram(datagram_with({}, 0)).empty());
}

}  // namespace sidestep::handshake_check_test
