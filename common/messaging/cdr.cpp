// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/cdr.hpp"

#include <exception>
#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include "common/messaging/topics.hpp"

namespace sidestep {
namespace {

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;

Cdr cdr_over(FastBuffer& buffer) { return Cdr(buffer, Cdr::LITTLE_ENDIANNESS, Cdr::CORBA_CDR); }

/// Whether the generated code can read the bytes safely. A type's sequence is its last member, so an
/// empty message ends with the sequence's count. A count beyond the bound would make the generated code
/// allocate that much memory.
template <typename Message>
[[nodiscard]] bool is_acceptable(std::span<const std::uint8_t> bytes, std::size_t max_elements) {
  static const std::size_t min_size = [] {
    std::vector<std::uint8_t> empty;
    const Message message;
    append_cdr<Message>(&message, empty);
    return empty.size();
  }();
  if (bytes.size() < min_size) return false;
  if (max_elements == 0) return bytes.size() == min_size;
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < 4; ++i) count |= std::uint32_t{bytes[min_size - 4 + i]} << (8 * i);
  return count <= max_elements;
}

}  // namespace

template <typename Message>
void append_cdr(const void* message, std::vector<std::uint8_t>& bytes) {
  const Message& typed = *static_cast<const Message*>(message);
  const std::size_t begin = bytes.size(), max_size = Message::getCdrSerializedSize(typed);
  bytes.resize(begin + max_size);
  FastBuffer buffer(reinterpret_cast<char*>(bytes.data() + begin), max_size);
  Cdr cdr = cdr_over(buffer);
  typed.serialize(cdr);
  bytes.resize(begin + cdr.getSerializedDataLength());
}

template <typename Message>
bool read_cdr(std::span<const std::uint8_t> bytes, std::size_t max_elements,
              const std::function<void(const void*)>& use) {
  if (!is_acceptable<Message>(bytes, max_elements)) return false;
  Message message;
  try {
    // FastBuffer takes a mutable pointer, but deserialisation only reads.
    FastBuffer buffer(reinterpret_cast<char*>(const_cast<std::uint8_t*>(bytes.data())), bytes.size());
    Cdr cdr = cdr_over(buffer);
    message.deserialize(cdr);
  } catch (const std::exception&) {
    return false;
  }
  use(&message);
  return true;
}

template void append_cdr<msg::CameraImage>(const void*, std::vector<std::uint8_t>&);
template bool read_cdr<msg::CameraImage>(std::span<const std::uint8_t>, std::size_t,
                                         const std::function<void(const void*)>&);
template void append_cdr<msg::DetectionFrame>(const void*, std::vector<std::uint8_t>&);
template bool read_cdr<msg::DetectionFrame>(std::span<const std::uint8_t>, std::size_t,
                                            const std::function<void(const void*)>&);
template void append_cdr<msg::WorldState>(const void*, std::vector<std::uint8_t>&);
template bool read_cdr<msg::WorldState>(std::span<const std::uint8_t>, std::size_t,
                                        const std::function<void(const void*)>&);
template void append_cdr<msg::Command>(const void*, std::vector<std::uint8_t>&);
template bool read_cdr<msg::Command>(std::span<const std::uint8_t>, std::size_t,
                                     const std::function<void(const void*)>&);
template void append_cdr<msg::Feedback>(const void*, std::vector<std::uint8_t>&);
template bool read_cdr<msg::Feedback>(std::span<const std::uint8_t>, std::size_t,
                                      const std::function<void(const void*)>&);
template void append_cdr<msg::Registration>(const void*, std::vector<std::uint8_t>&);
template bool read_cdr<msg::Registration>(std::span<const std::uint8_t>, std::size_t,
                                          const std::function<void(const void*)>&);
template void append_cdr<msg::Proposal>(const void*, std::vector<std::uint8_t>&);
template bool read_cdr<msg::Proposal>(std::span<const std::uint8_t>, std::size_t,
                                      const std::function<void(const void*)>&);
template void append_cdr<msg::Verdict>(const void*, std::vector<std::uint8_t>&);
template bool read_cdr<msg::Verdict>(std::span<const std::uint8_t>, std::size_t,
                                     const std::function<void(const void*)>&);
template void append_cdr<msg::LedgerPage>(const void*, std::vector<std::uint8_t>&);
template bool read_cdr<msg::LedgerPage>(std::span<const std::uint8_t>, std::size_t,
                                        const std::function<void(const void*)>&);
template void append_cdr<msg::CoordinatorState>(const void*, std::vector<std::uint8_t>&);
template bool read_cdr<msg::CoordinatorState>(std::span<const std::uint8_t>, std::size_t,
                                              const std::function<void(const void*)>&);
template void append_cdr<msg::AgentStatus>(const void*, std::vector<std::uint8_t>&);
template bool read_cdr<msg::AgentStatus>(std::span<const std::uint8_t>, std::size_t,
                                         const std::function<void(const void*)>&);
template void append_cdr<msg::Disturbance>(const void*, std::vector<std::uint8_t>&);
template bool read_cdr<msg::Disturbance>(std::span<const std::uint8_t>, std::size_t,
                                         const std::function<void(const void*)>&);
template void append_cdr<msg::NetworkFault>(const void*, std::vector<std::uint8_t>&);
template bool read_cdr<msg::NetworkFault>(std::span<const std::uint8_t>, std::size_t,
                                          const std::function<void(const void*)>&);
template void append_cdr<msg::GroundTruth>(const void*, std::vector<std::uint8_t>&);
template bool read_cdr<msg::GroundTruth>(std::span<const std::uint8_t>, std::size_t,
                                         const std::function<void(const void*)>&);

}  // namespace sidestep
