// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/types.hpp"

#include <algorithm>
#include <cstring>

#include "tests/catch.hpp"
#include "tests/unit/common/messaging/dds/test_support.hpp"

namespace sidestep::types_test {

using Payload = GuardedType::Payload;

/// Decodes payloads into a sample of a topic's type.
class Decoder {
 public:
  explicit Decoder(const TopicInfo& topic) : type_(topic.type), sample_(type_.make_sample()) {}
  ~Decoder() { type_.delete_sample(sample_); }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  bool accepts(const std::vector<std::uint8_t>& bytes) {
    Payload payload(static_cast<std::uint32_t>(bytes.size() + 1));
    if (!bytes.empty()) std::memcpy(payload.data, bytes.data(), bytes.size());
    payload.length = static_cast<std::uint32_t>(bytes.size());
    REQUIRE(type_.read(payload, sample_));
    return sample().is_valid;
  }
  template <typename Message>
  const Message& message() {
    return *static_cast<const Message*>(sample().message);
  }
  GuardedType::Sample& sample() { return *static_cast<GuardedType::Sample*>(sample_); }
  GuardedType& type() { return type_; }

 private:
  GuardedType type_;
  void* sample_;
};

template <typename Message>
std::vector<std::uint8_t> bytes_of(const TopicInfo& topic, Message& message) {
  GuardedType type(topic.type);
  GuardedType::Sample sample{&message, true};
  Payload payload(type.payload_size(&sample));
  REQUIRE(type.write(&sample, payload));
  return {payload.data, payload.data + payload.length};
}

/// The message as a big-endian machine would send it.
template <typename Message>
std::vector<std::uint8_t> big_endian_bytes_of(const Message& message) {
  std::vector<std::uint8_t> result(4 + fast_dds::cdr_size(message), 0);
  fast_dds::CdrCoder(std::span(result).subspan(4), ByteOrder::kBigEndian).write(message);
  return result;
}

TEST_CASE("the DDS type of every topic has the name given in the topic table") {
  for (const TopicInfo& topic : all_topics()) {
    CAPTURE(topic.name);
    CHECK(GuardedType(topic.type).name() == topic.type.name);
    CHECK(GuardedType(topic.type).is_keyed());
  }
}

TEST_CASE("random bytes are refused without harm") {
  const std::uint64_t seed = GENERATE(1, 2, 3);
  Rng rng(seed);
  for (const TopicInfo& topic : all_topics()) {
    CAPTURE(seed, topic.name);
    Decoder decoder(topic);
    int accepted = 0;
    for (int i = 0; i < 10000; ++i) {
      std::vector<std::uint8_t> bytes(rng.below(3000));
      for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(rng.bits());
      if (rng.chance(0.5) && bytes.size() >= 4) bytes[0] = 0, bytes[1] = bytes[1] & 1;
      accepted += decoder.accepts(bytes);
    }
    // Only a type without sequences and booleans accepts arbitrary bytes of its length.
    CHECK(accepted < 10000);
    if (topic.type.max_elements > 0) CHECK(accepted == 0);
  }
}

TEST_CASE("a sequence longer than the type's bound is refused before memory is allocated for it") {
  Rng rng(7);
  Decoder decoder(topics::kWorld);
  msg::WorldState world = random_message<msg::WorldState>(rng, true, 0);
  std::vector<std::uint8_t> bytes = bytes_of(topics::kWorld, world);
  CHECK(decoder.accepts(bytes));
  const auto max = static_cast<std::uint32_t>(topics::kWorld.type.max_elements);
  for (const std::uint32_t count : {max + 1, 1u << 24, 0x7fffffffu, 0xffffffffu}) {
    CAPTURE(count);
    std::memcpy(bytes.data() + bytes.size() - 4, &count, sizeof count);
    CHECK_FALSE(decoder.accepts(bytes));
    CHECK(decoder.message<msg::WorldState>().robots().capacity() <= max);
  }
}

TEST_CASE("a sequence of exactly the type's maximum length is accepted in either byte order") {
  Rng rng(8);
  Decoder decoder(topics::kWorld);
  msg::WorldState world = random_message<msg::WorldState>(
      rng, true, static_cast<std::uint32_t>(topics::kWorld.type.max_elements));
  CHECK(decoder.accepts(bytes_of(topics::kWorld, world)));
  CHECK(decoder.message<msg::WorldState>() == world);
  decoder.accepts({});
  CHECK(decoder.accepts(big_endian_bytes_of(world)));
  CHECK(decoder.message<msg::WorldState>() == world);
  std::vector<std::uint8_t> too_long = big_endian_bytes_of(random_message<msg::WorldState>(rng, true, 0));
  too_long[too_long.size() - 4] = 1;  // states 2^24 robots
  CHECK_FALSE(decoder.accepts(too_long));
}

TEST_CASE("a payload that is too short by any number of bytes is refused") {
  Rng rng(9);
  msg::Command command = random_message<msg::Command>(rng, false, 0);
  msg::WorldState world = random_message<msg::WorldState>(rng, true, 3);
  Decoder commands(topics::kCommand);
  Decoder worlds(topics::kWorld);
  const auto check = [](Decoder& decoder, std::vector<std::uint8_t> bytes) {
    REQUIRE(decoder.accepts(bytes));
    while (!bytes.empty()) {
      bytes.pop_back();
      CAPTURE(bytes.size());
      CHECK_FALSE(decoder.accepts(bytes));
    }
  };
  check(commands, bytes_of(topics::kCommand, command));
  check(worlds, bytes_of(topics::kWorld, world));
}

TEST_CASE("a boolean that is neither true nor false is refused") {
  Rng rng(10);
  msg::Command command = random_message<msg::Command>(rng, false, 0);
  command.has_version(true);
  std::vector<std::uint8_t> bytes = bytes_of(topics::kCommand, command);
  msg::Command other = command;
  other.has_version(false);
  const std::vector<std::uint8_t> other_bytes = bytes_of(topics::kCommand, other);
  const auto position = std::mismatch(bytes.begin(), bytes.end(), other_bytes.begin()).first;
  REQUIRE(position != bytes.end());
  *position = 2;
  Decoder decoder(topics::kCommand);
  CHECK_FALSE(decoder.accepts(bytes));
  *position = 1;
  CHECK(decoder.accepts(bytes));
}

TEST_CASE("a message that does not fit into its payload is not written") {
  Rng rng(12);
  msg::WorldState world = random_message<msg::WorldState>(rng, true, 3);
  GuardedType type(topics::kWorld.type);
  GuardedType::Sample sample{&world, true};
  const std::uint32_t size = type.payload_size(&sample);
  for (const std::uint32_t space : {1u, 4u, size - 1}) {
    CAPTURE(space);
    Payload payload(space);
    CHECK_FALSE(type.write(&sample, payload));
  }
  Payload payload(size + 100);
  CHECK(type.write(&sample, payload));
  CHECK(payload.length == size);
}

TEST_CASE("samples have equal handles if and only if their keys are equal") {
  Decoder decoder(topics::kVerdict);
  const auto handle_of = [&](std::uint32_t robot) {
    msg::Verdict verdict;
    verdict.header().sender(static_cast<std::uint32_t>(Sender::kCoordinator));
    verdict.robot(robot);
    GuardedType::Sample sample{&verdict, true};
    fast_dds::rtps::InstanceHandle_t handle;
    REQUIRE(decoder.type().key(&sample, handle));
    return handle;
  };
  CHECK(handle_of(5) == handle_of(5));
  CHECK_FALSE(handle_of(5) == handle_of(6));
  CHECK(handle_of(0x01020304).value[3] == 4);  // big-endian, as all vendors compute it (RTPS 2.2, 9.6.3.3)
}

}  // namespace sidestep::types_test
