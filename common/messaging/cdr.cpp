// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/cdr.hpp"

#include <exception>

#include "common/messaging/topics.hpp"

namespace sidestep {
namespace {

using fast_dds::CdrCoder;
using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kCountSize = 4;
constexpr std::size_t kMaxPadding = 3;

std::uint32_t read_uint32(Bytes bytes, ByteOrder order) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) {
    const int shift = order == ByteOrder::kBigEndian ? 24 - 8 * i : 8 * i;
    value |= std::uint32_t{bytes[static_cast<std::size_t>(i)]} << shift;
  }
  return value;
}

/// Size of a message with an empty sequence. If the type has no sequence, the fixed size of its messages.
template <typename Message>
std::size_t min_size() {
  static const std::size_t size = fast_dds::cdr_size(Message());
  return size;
}

/// Whether the generated code can read the bytes safely. A type's sequence is its last member, so a message
/// with an empty sequence ends with the sequence's count. For a count beyond the bound, the generated code
/// would allocate that much memory.
template <typename Message>
[[nodiscard]] bool is_acceptable(Bytes bytes, ByteOrder order, std::size_t max_elements) {
  if (bytes.size() < min_size<Message>()) return false;
  return max_elements == 0 ||
         read_uint32(bytes.subspan(min_size<Message>() - kCountSize, kCountSize), order) <= max_elements;
}

}  // namespace

template <typename Message>
std::shared_ptr<void> make_message() {
  return std::make_shared<Message>();
}

template <typename Message>
std::shared_ptr<const void> copy_message(const void* message) {
  return std::make_shared<const Message>(*static_cast<const Message*>(message));
}

template <typename Message>
std::uint32_t message_sender(const void* message) {
  return static_cast<const Message*>(message)->header().sender();
}

template <typename Message>
std::size_t cdr_size(const void* message) {
  return fast_dds::cdr_size(*static_cast<const Message*>(message));
}

template <typename Message>
std::size_t write_cdr(const void* message, std::span<std::uint8_t> bytes) {
  try {
    CdrCoder coder(bytes, ByteOrder::kLittleEndian);
    coder.write(*static_cast<const Message*>(message));
    return coder.position();
  } catch (const std::exception&) {
    return 0;
  }
}

template <typename Message>
CdrKey cdr_key(const void* message) {
  CdrKey result{};
  CdrCoder(result, ByteOrder::kBigEndian).write_key(*static_cast<const Message*>(message));
  return result;
}

template <typename Message>
bool read_cdr(Bytes bytes, ByteOrder order, std::size_t max_elements, void* message) {
  if (!is_acceptable<Message>(bytes, order, max_elements)) return false;
  try {
    CdrCoder coder(bytes, order);
    coder.read(*static_cast<Message*>(message));
    // If the bytes end between two members, Fast CDR 2 accepts this as the end of the message.
    const std::size_t whole = max_elements == 0 ? min_size<Message>() : cdr_size<Message>(message);
    return coder.position() == whole && bytes.size() - coder.position() <= kMaxPadding;
  } catch (const std::exception&) {
    return false;
  }
}

// One instantiation for each message of the topic table.
#define SIDESTEP_INSTANTIATE_CDR(Message)                                             \
  template std::shared_ptr<void> make_message<msg::Message>();                        \
  template std::shared_ptr<const void> copy_message<msg::Message>(const void*);       \
  template std::uint32_t message_sender<msg::Message>(const void*);                   \
  template std::size_t cdr_size<msg::Message>(const void*);                           \
  template std::size_t write_cdr<msg::Message>(const void*, std::span<std::uint8_t>); \
  template CdrKey cdr_key<msg::Message>(const void*);                                 \
  template bool read_cdr<msg::Message>(Bytes, ByteOrder, std::size_t, void*);
SIDESTEP_INSTANTIATE_CDR(CameraImage)
SIDESTEP_INSTANTIATE_CDR(DetectionFrame)
SIDESTEP_INSTANTIATE_CDR(WorldState)
SIDESTEP_INSTANTIATE_CDR(ObstacleList)
SIDESTEP_INSTANTIATE_CDR(Command)
SIDESTEP_INSTANTIATE_CDR(Feedback)
SIDESTEP_INSTANTIATE_CDR(LaserScan)
SIDESTEP_INSTANTIATE_CDR(Registration)
SIDESTEP_INSTANTIATE_CDR(Proposal)
SIDESTEP_INSTANTIATE_CDR(Verdict)
SIDESTEP_INSTANTIATE_CDR(LedgerPage)
SIDESTEP_INSTANTIATE_CDR(CoordinatorState)
SIDESTEP_INSTANTIATE_CDR(AbsenceAttestation)
SIDESTEP_INSTANTIATE_CDR(Order)
SIDESTEP_INSTANTIATE_CDR(OrderAnswer)
SIDESTEP_INSTANTIATE_CDR(OrderMemory)
SIDESTEP_INSTANTIATE_CDR(OrderStatus)
SIDESTEP_INSTANTIATE_CDR(Course)
SIDESTEP_INSTANTIATE_CDR(CourseOffer)
SIDESTEP_INSTANTIATE_CDR(AgentStatus)
SIDESTEP_INSTANTIATE_CDR(Counters)
SIDESTEP_INSTANTIATE_CDR(ClockProbe)
SIDESTEP_INSTANTIATE_CDR(ClockReading)
SIDESTEP_INSTANTIATE_CDR(Disturbance)
SIDESTEP_INSTANTIATE_CDR(DisturbanceAnswer)
SIDESTEP_INSTANTIATE_CDR(NetworkFault)
SIDESTEP_INSTANTIATE_CDR(GroundTruth)
SIDESTEP_INSTANTIATE_CDR(SharedRules)
#undef SIDESTEP_INSTANTIATE_CDR

}  // namespace sidestep
