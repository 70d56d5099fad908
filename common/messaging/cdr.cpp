// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/cdr.hpp"

#include <cstring>
#include <exception>
#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <stdexcept>

namespace sidestep {
namespace {

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;

Cdr cdr_over(FastBuffer& buffer) { return Cdr(buffer, Cdr::LITTLE_ENDIANNESS, Cdr::CORBA_CDR); }

template <typename Message>
void append(const void* message, std::vector<std::uint8_t>& bytes) {
  const Message& typed = *static_cast<const Message*>(message);
  const std::size_t begin = bytes.size(), most = Message::getCdrSerializedSize(typed);
  bytes.resize(begin + most);
  FastBuffer buffer(reinterpret_cast<char*>(bytes.data() + begin), most);
  Cdr cdr = cdr_over(buffer);
  typed.serialize(cdr);
  bytes.resize(begin + cdr.getSerializedDataLength());
}

/// The sequence, if the type has one, is its last member: so its count ends an empty message. A count beyond
/// the bound would make the generated code ask for that much memory.
template <typename Message>
bool is_acceptable(std::span<const std::uint8_t> bytes, std::size_t max_elements) {
  static const std::size_t smallest = [] {
    std::vector<std::uint8_t> empty;
    const Message message;
    append<Message>(&message, empty);
    return empty.size();
  }();
  if (bytes.size() < smallest) return false;
  if (max_elements == 0) return bytes.size() == smallest;
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < 4; ++i) count |= std::uint32_t{bytes[smallest - 4 + i]} << (8 * i);
  return count <= max_elements;
}

template <typename Message>
bool read(std::span<const std::uint8_t> bytes, std::size_t max_elements,
          const std::function<void(const void*)>& use) {
  if (!is_acceptable<Message>(bytes, max_elements)) return false;
  Message message;
  try {
    // The buffer is only read, but its constructor does not say so.
    FastBuffer buffer(reinterpret_cast<char*>(const_cast<std::uint8_t*>(bytes.data())), bytes.size());
    Cdr cdr = cdr_over(buffer);
    message.deserialize(cdr);
  } catch (const std::exception&) {
    return false;
  }
  use(&message);
  return true;
}

struct Codec {
  const char* type;
  void (*append)(const void*, std::vector<std::uint8_t>&);
  bool (*read)(std::span<const std::uint8_t>, std::size_t, const std::function<void(const void*)>&);
};

template <typename Message>
constexpr Codec codec(const Topic<Message>& topic) {
  return {topic.type.name, append<Message>, read<Message>};
}

constexpr Codec kCodecs[] = {
    codec(topics::kImages),       codec(topics::kDetections), codec(topics::kWorld),
    codec(topics::kCommand),      codec(topics::kFeedback),   codec(topics::kRegistration),
    codec(topics::kProposal),     codec(topics::kVerdict),    codec(topics::kLedger),
    codec(topics::kCoordinator),  codec(topics::kStatus),     codec(topics::kDisturbance),
    codec(topics::kNetworkFault), codec(topics::kTruth),
};

const Codec& codec_of(const TopicInfo& topic) {
  for (const Codec& codec : kCodecs) {
    if (std::strcmp(codec.type, topic.type.name) == 0) return codec;
  }
  throw std::logic_error(std::string("no codec for ") + topic.type.name);
}

}  // namespace

void append_cdr(const TopicInfo& topic, const void* message, std::vector<std::uint8_t>& bytes) {
  codec_of(topic).append(message, bytes);
}

bool read_cdr(const TopicInfo& topic, std::span<const std::uint8_t> bytes,
              const std::function<void(const void*)>& use) {
  return codec_of(topic).read(bytes, topic.type.max_elements, use);
}

}  // namespace sidestep
