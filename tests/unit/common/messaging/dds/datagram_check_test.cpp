// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/datagram_check.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "common/messaging/dds/bus.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::datagram_check_test {

using Bytes = std::vector<std::uint8_t>;

/// Builds the body of a submessage from little-endian 2-byte and 4-byte numbers, and zeros.
struct Body {
  Bytes bytes;
  Body& u16(std::uint32_t value) { return append(value, 2); }
  Body& u32(std::uint32_t value) { return append(value, 4); }
  Body& zeros(std::size_t count) {
    bytes.resize(bytes.size() + count);
    return *this;
  }
  Body& sequence_number(std::uint32_t value, std::uint32_t high = 0) { return u32(high).u32(value); }
  /// The ids of reader and writer. By default: any reader, and the writer that announces endpoints.
  Body& entities(const Bytes& writer = {0, 0, 3, 0xc2}, const Bytes& reader = {0, 0, 0, 0}) {
    for (const Bytes* entity : {&reader, &writer}) bytes.insert(bytes.end(), entity->begin(), entity->end());
    return *this;
  }

 private:
  Body& append(std::uint32_t value, int size) {
    for (int i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> 8 * i));
    return *this;
  }
};

Bytes submessage(std::uint8_t kind, const Body& body, std::uint8_t flags = 1) {
  Bytes result{kind, flags};
  const Body size = Body().u16(static_cast<std::uint32_t>(body.bytes.size()));
  result.insert(result.end(), size.bytes.begin(), size.bytes.end());
  result.insert(result.end(), body.bytes.begin(), body.bytes.end());
  return result;
}

Bytes joined(const std::vector<Bytes>& parts) {
  Bytes result;
  for (const Bytes& part : parts) result.insert(result.end(), part.begin(), part.end());
  return result;
}

Bytes datagram(const std::vector<Bytes>& submessages) {
  Bytes header{'R', 'T', 'P', 'S', 2, 2, 1, 15};
  header.resize(20);
  return joined({header, joined(submessages)});
}

Body data_header(std::uint32_t to_inline_qos = 16, std::uint32_t number = 7) {
  return Body().u16(0).u16(to_inline_qos).entities().sequence_number(number);
}
Bytes data() { return submessage(0x15, data_header().zeros(12), 5); }
Bytes data_with_qos() { return submessage(0x15, data_header().u16(0x70).u16(4).u32(3).u16(1).u16(0), 3); }
Bytes acknowledgement(std::uint32_t bits, std::size_t words) {
  return submessage(0x06, Body().entities().sequence_number(0).u32(bits).zeros(4 * words).u32(1));
}
Bytes gap(std::uint32_t start, std::uint32_t bits, std::size_t words) {
  return submessage(0x08,
                    Body().entities().sequence_number(start).sequence_number(4).u32(bits).zeros(4 * words));
}
Bytes heartbeat(std::uint32_t first, std::uint32_t last) {
  return submessage(0x07, Body().entities().sequence_number(first).sequence_number(last).u32(1));
}
/// A submessage of a discovery message with this sequence number from this writer to this reader.
Bytes numbered(std::uint8_t kind, std::uint32_t low, std::uint32_t high,
               const Bytes& writer = {0, 0, 3, 0xc2}, const Bytes& reader = {0, 0, 0, 0}) {
  const Body number = Body().entities(writer, reader).sequence_number(low, high);
  const auto with = [&](Body rest) {
    Body body = number;
    body.bytes.insert(body.bytes.end(), rest.bytes.begin(), rest.bytes.end());
    return body;
  };
  switch (kind) {
    case 0x06:
      return submessage(kind, with(Body().u32(0).u32(1)));
    case 0x07:
      return submessage(kind, with(Body().sequence_number(low, high).u32(1)));
    case 0x08:
      return submessage(kind, with(Body().sequence_number(low, high).u32(0)));
    default: {
      Body body = Body().u16(0).u16(16);
      body.bytes.insert(body.bytes.end(), number.bytes.begin(), number.bytes.end());
      return submessage(0x15, body.zeros(12), 5);
    }
  }
}
Bytes encrypted(std::uint32_t stated, std::size_t present, std::uint8_t codes = 0, std::size_t prefix = 20,
                std::size_t postfix = 20) {
  Body body;
  for (int shift = 24; shift >= 0; shift -= 8)
    body.bytes.push_back(static_cast<std::uint8_t>(stated >> shift));
  body.zeros(present);
  Body code = Body().zeros(postfix);
  code.bytes.back() = codes;
  return joined({submessage(0x31, Body().zeros(prefix)), submessage(0x30, body), submessage(0x32, code)});
}
Bytes statistics(std::size_t size = 56) { return submessage(0x80, Body().zeros(size)); }

std::vector<Bytes> valid_submessages() {
  return {data(),
          data_with_qos(),
          acknowledgement(0, 0),
          acknowledgement(33, 2),
          acknowledgement(256, 8),
          gap(2, 0, 0),
          gap(2, 40, 2),
          heartbeat(1, 0),
          heartbeat(3, 9),
          submessage(0x09, Body().zeros(8)),
          submessage(0x0e, Body().zeros(12)),
          encrypted(16, 16),
          encrypted(13, 16)};
}

bool passes(const Bytes& bytes) { return !checked_datagram(bytes).empty(); }

TEST_CASE("every submessage of a process with keys passes, and statistics at the end are removed") {
  const std::vector<Bytes> all = valid_submessages();
  for (const Bytes& one : all) {
    CAPTURE(int{one[0]});
    CHECK(checked_datagram(datagram({one})).size() == 20 + one.size());
    CHECK(checked_datagram(datagram({one, statistics()})).size() == 20 + one.size());
  }
  CHECK(checked_datagram(datagram({joined(all), statistics()})).size() == 20 + joined(all).size());
}

TEST_CASE("a truncated datagram is dropped unless it ends between submessages") {
  for (const Bytes& one : valid_submessages()) {
    const Bytes whole = datagram({one, one});
    for (std::size_t size = 0; size < whole.size(); ++size) {
      CAPTURE(int{one[0]}, size);
      CHECK(passes({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}) ==
            (size == 20 + one.size()));
    }
  }
}

TEST_CASE("statistics that are misplaced, repeated, alone or of the wrong size are dropped") {
  CHECK_FALSE(passes(datagram({statistics()})));
  CHECK_FALSE(passes(datagram({statistics(), data()})));
  CHECK_FALSE(passes(datagram({data(), statistics(), statistics()})));
  CHECK_FALSE(passes(datagram({data(), statistics(), data(), statistics()})));
  for (const std::size_t size : {0u, 52u, 60u}) CHECK_FALSE(passes(datagram({data(), statistics(size)})));
}

TEST_CASE("submessages of unknown kinds or with contradictory numbers are dropped") {
  const std::vector<std::pair<const char*, Bytes>> bad{
      {"an unknown kind", submessage(0x20, Body().zeros(8))},
      {"one that fills up", submessage(0x01, Body().zeros(8))},
      {"one that changes the sender", submessage(0x0c, Body().zeros(20))},
      {"one that changes where answers go", submessage(0x0f, Body().zeros(8))},
      {"a time of another size", submessage(0x09, Body().zeros(4))},
      {"a destination of another size", submessage(0x0e, Body().zeros(16))},
      {"a size that is no multiple of 4", submessage(0x09, Body().zeros(9))},
      {"data without a header", submessage(0x15, Body().zeros(16), 5)},
      {"data with an offset of its own", submessage(0x15, data_header(20).zeros(12), 5)},
      {"data with number 0", submessage(0x15, data_header(16, 0).zeros(12), 5)},
      {"data and a key", submessage(0x15, data_header().zeros(12), 13)},
      {"data that is empty", submessage(0x15, data_header(), 5)},
      {"data that nobody announces", submessage(0x15, data_header().zeros(12), 1)},
      {"parameters without an end", submessage(0x15, data_header().u16(0x70).u16(4).u32(3), 3)},
      {"a parameter that is too long",
       submessage(0x15, data_header().u16(0x70).u16(64).u32(3).u16(1).u16(0), 3)},
      {"a parameter of an odd size",
       submessage(0x15, data_header().u16(0x70).u16(2).u16(3).u16(1).u16(0).u16(0), 3)},
      {"a fragment",
       submessage(
           0x16,
           Body().u16(0).u16(28).entities().sequence_number(7).u32(1).u16(1).u16(40).u32(100).zeros(40))},
      {"missing fragments",
       submessage(0x12, Body().entities().sequence_number(3).u32(1).u32(8).zeros(4).u32(1))},
      {"a heartbeat of fragments", submessage(0x13, Body().entities().sequence_number(3).u32(2).u32(1))},
      {"an acknowledgement of 257 messages", acknowledgement(257, 9)},
      {"an acknowledgement with too few bits", acknowledgement(33, 1)},
      {"an acknowledgement with too many bits", acknowledgement(32, 2)},
      {"a gap from number 0", gap(0, 0, 0)},
      {"a gap with too few bits", gap(2, 40, 1)},
      {"a heartbeat from number 0", heartbeat(0, 5)},
      {"a heartbeat that ends before it begins", heartbeat(5, 3)},
      {"encrypted content longer than the datagram", encrypted(2000, 16)},
      {"encrypted content longer than its submessage", encrypted(17, 16)},
      {"encrypted content with more after it", encrypted(12, 16)},
      {"encrypted nothing", encrypted(0, 0)},
      {"codes for single receivers", encrypted(16, 16, 1)},
      {"a longer prefix", encrypted(16, 16, 0, 24)},
      {"a shorter prefix", encrypted(16, 16, 0, 16)},
      {"a longer code", encrypted(16, 16, 0, 20, 40)},
      {"a prefix alone", submessage(0x31, Body().zeros(20))},
      {"content alone", submessage(0x30, Body().u32(0x04000000).zeros(4))},
      {"a code alone", submessage(0x32, Body().zeros(20))}};
  for (const auto& [what, bytes] : bad) {
    CAPTURE(what);
    CHECK_FALSE(passes(datagram({bytes})));
    CHECK_FALSE(passes(datagram({data(), bytes, data()})));
  }
  CHECK_FALSE(passes(datagram({})));
}

TEST_CASE("sequence numbers larger than discovery uses are refused") {
  for (const std::uint8_t kind : {0x06, 0x07, 0x08, 0x15}) {
    CAPTURE(int{kind});
    CHECK(passes(datagram({numbered(kind, (1 << 15) - 1, 0)})));
    for (const auto& [low, high] :
         {std::pair{1u << 15, 0u}, {0u, 1u}, {5u, 0x7fffffffu}, {5u, 0xffffffffu}, {0u, 0x80000000u}}) {
      CAPTURE(low, high);
      CHECK_FALSE(passes(datagram({numbered(kind, low, high)})));
    }
  }
}

TEST_CASE("only discovery messages may be unencrypted") {
  const bool is_version_3 = fast_dds_version().starts_with("3");
  for (const std::uint8_t kind : {0x06, 0x07, 0x08, 0x15}) {
    CAPTURE(int{kind});
    CHECK(passes(datagram({numbered(kind, 5, 0, {0, 0, 3, 0xc2}, {0, 0, 3, 0xc7})})));
    // Announcements sent to participants that have proved their keys.
    CHECK(passes(datagram({numbered(kind, 5, 0, {0xff, 1, 1, 0xc2}, {0xff, 1, 1, 0xc7})})) == is_version_3);
    CHECK_FALSE(passes(datagram({numbered(kind, 5, 0, {0, 0, 1, 0x02})})));
    CHECK_FALSE(passes(datagram({numbered(kind, 5, 0, {0, 0, 1, 0x02}, {0, 0, 1, 0x07})})));
    CHECK_FALSE(passes(datagram({numbered(kind, 5, 0, {0, 0, 3, 0xc2}, {0, 0, 1, 0x07})})));
    CHECK_FALSE(passes(datagram({numbered(kind, 5, 0, {0, 0, 3, 0xc2}, {0, 0, 4, 0xc7})})));
    // Key exchange, liveliness and discovery messages that must be encrypted.
    CHECK_FALSE(passes(datagram({numbered(kind, 5, 0, {0xff, 2, 2, 0xc3}, {0xff, 2, 2, 0xc4})})));
    CHECK_FALSE(passes(datagram({numbered(kind, 5, 0, {0xff, 2, 0, 0xc2}, {0xff, 2, 0, 0xc7})})));
    CHECK_FALSE(passes(datagram({numbered(kind, 5, 0, {0xff, 0, 3, 0xc2})})));
  }
}

TEST_CASE("the writer of protected liveliness has no messages, and its readers only ask for a heartbeat") {
  const Bytes writer{0xff, 2, 0, 0xc2}, reader{0xff, 2, 0, 0xc7};
  const auto ask = [&](std::uint32_t number, std::uint32_t bits = 0, std::uint32_t high = 0) {
    return submessage(0x06, Body()
                                .entities(writer, reader)
                                .sequence_number(number, high)
                                .u32(bits)
                                .zeros((bits + 31) / 32 * 4)
                                .u32(7));
  };
  const auto answer = [&](std::uint32_t first, std::uint32_t last) {
    return submessage(0x07,
                      Body().entities(writer, reader).sequence_number(first).sequence_number(last).u32(7));
  };
  CHECK(passes(datagram({submessage(0x0e, Body().zeros(12)), ask(0)})));
  CHECK(passes(datagram({ask(1)})));  // after a heartbeat
  CHECK(passes(datagram({answer(1, 0)})));
  CHECK_FALSE(passes(datagram({ask(2)})));
  CHECK_FALSE(passes(datagram({ask(0, 0, 1)})));
  for (const std::uint32_t bits : {1u, 32u, 256u}) CHECK_FALSE(passes(datagram({ask(1, bits)})));
  CHECK_FALSE(passes(datagram({answer(1, 1)})));
  CHECK_FALSE(passes(datagram({answer(2, 1)})));
  CHECK_FALSE(passes(datagram({answer(0, 0)})));
  for (const std::uint8_t kind : {0x08, 0x15})
    CHECK_FALSE(passes(datagram({numbered(kind, 1, 0, writer, reader)})));
  // Only these two endpoints.
  for (const std::uint8_t kind : {0x06, 0x07}) {
    CHECK_FALSE(passes(datagram({numbered(kind, 1, 0, writer)})));
    CHECK_FALSE(passes(datagram({numbered(kind, 1, 0, writer, {0, 2, 0, 0xc7})})));
    CHECK_FALSE(passes(datagram({numbered(kind, 1, 0, {0, 2, 0, 0xc2}, reader)})));
    CHECK_FALSE(passes(datagram({numbered(kind, 1, 0, {0xff, 2, 2, 0xc3}, {0xff, 2, 2, 0xc4})})));
  }
}

TEST_CASE("if a corrupted datagram passes, the passed part is a prefix of the datagram and passes again") {
  const std::uint64_t seed = GENERATE(1u, 2u);
  CAPTURE(seed);
  Rng rng(seed);
  const std::vector<Bytes> all = valid_submessages();
  int passed = 0;
  for (int i = 0; i < 100'000; ++i) {
    std::vector<Bytes> parts;
    for (std::uint64_t left = 1 + rng.below(4); left > 0; --left) parts.push_back(all[rng.below(all.size())]);
    if (rng.chance(0.7)) parts.push_back(statistics());
    Bytes bytes = datagram(parts);
    for (std::uint64_t left = rng.below(4); left > 0; --left)
      bytes[20 + rng.below(bytes.size() - 20)] = static_cast<std::uint8_t>(rng.bits());
    if (rng.chance(0.1)) bytes.resize(rng.below(bytes.size()));
    const auto checked = checked_datagram(bytes);
    if (checked.empty()) continue;
    ++passed;
    const auto again = checked_datagram(checked);
    const bool is_beginning = checked.data() == bytes.data() && checked.size() <= bytes.size();
    if (!is_beginning || again.size() != checked.size()) FAIL("datagram " << i);
  }
  CHECK(passed > 20'000);
  CHECK(passed < 90'000);
}

TEST_CASE("without keys, statistics are removed or dropped, and unknown submessages pass") {
  const auto rest = [](const std::vector<Bytes>& parts) {
    return without_statistics(datagram(parts)).size();
  };
  const Bytes other = submessage(0x0c, Body().zeros(20)), odd = submessage(0x55, Body().zeros(6));
  CHECK(rest({other, data()}) == 20 + other.size() + data().size());
  CHECK(rest({data(), statistics()}) == 20 + data().size());
  CHECK(rest({odd, Bytes(2), statistics()}) == 20 + odd.size() + 2);
  CHECK(rest({statistics(), data()}) == 0);
  CHECK(rest({data(), statistics(), data(), statistics()}) == 0);
  CHECK(rest({data(), statistics(60)}) == 0);
  // The last submessage may omit its size.
  Bytes last = data();
  last[2] = last[3] = 0;
  CHECK(rest({last, statistics()}) == datagram({last, statistics()}).size());
}

}  // namespace sidestep::datagram_check_test
