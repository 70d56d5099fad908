// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/types.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <vector>

namespace sidestep {
namespace {

using fast_dds::rtps::InstanceHandle_t;

constexpr std::size_t kEncapsulationSize = 4;
constexpr std::uint8_t kBigEndianCdr = 0, kLittleEndianCdr = 1;  ///< second byte of the encapsulation header

GuardedType::Sample& to_sample(void* sample) { return *static_cast<GuardedType::Sample*>(sample); }
const void* message_in(const void* sample) {
  return static_cast<const GuardedType::Sample*>(sample)->message;
}
std::vector<std::uint8_t>& to_bytes(void* sample) { return *static_cast<std::vector<std::uint8_t>*>(sample); }
const std::vector<std::uint8_t>& to_bytes(const void* sample) {
  return *static_cast<const std::vector<std::uint8_t>*>(sample);
}

std::uint32_t size_of_empty(const MessageType& type) {
  return static_cast<std::uint32_t>(kEncapsulationSize + type.cdr_size(type.make().get()));
}

/// A sample that owns its message; Fast DDS stores only the sample's address.
struct OwnedSample : GuardedType::Sample {
  explicit OwnedSample(std::shared_ptr<void> made) : owner(std::move(made)) { message = owner.get(); }
  std::shared_ptr<void> owner;
};

}  // namespace

GuardedType::GuardedType(const MessageType& type)
    : DataType(type.name, /*is_keyed=*/type.cdr_key != nullptr, size_of_empty(type)), type_(type) {}

void* GuardedType::make_sample() { return static_cast<Sample*>(new OwnedSample(type_.make())); }

void GuardedType::delete_sample(void* sample) { delete static_cast<OwnedSample*>(&to_sample(sample)); }

std::uint32_t GuardedType::payload_size(const void* sample) {
  return static_cast<std::uint32_t>(kEncapsulationSize + type_.cdr_size(message_in(sample)));
}

bool GuardedType::write(const void* sample, Payload& payload) {
  if (payload.max_size < kEncapsulationSize) return false;
  constexpr std::array<std::uint8_t, kEncapsulationSize> kEncapsulation{0, kLittleEndianCdr, 0, 0};
  std::ranges::copy(kEncapsulation, payload.data);
  const std::span<std::uint8_t> space(payload.data, payload.max_size);
  const std::size_t written = type_.write_cdr(message_in(sample), space.subspan(kEncapsulationSize));
  payload.encapsulation = CDR_LE;
  payload.length = static_cast<std::uint32_t>(kEncapsulationSize + written);
  return written > 0;
}

bool GuardedType::read(const Payload& payload, void* sample) {
  Sample& result = to_sample(sample);
  result.is_valid = false;
  if (payload.data == nullptr || payload.length < kEncapsulationSize) return true;
  const std::span<const std::uint8_t> bytes(payload.data, payload.length);
  if (bytes[0] != 0 || bytes[1] > kLittleEndianCdr) return true;
  const ByteOrder order = bytes[1] == kBigEndianCdr ? ByteOrder::kBigEndian : ByteOrder::kLittleEndian;
  result.is_valid =
      type_.read_cdr(bytes.subspan(kEncapsulationSize), order, type_.max_elements, result.message);
  return true;
}

bool GuardedType::key(const void* sample, InstanceHandle_t& handle) {
  if (!type_.cdr_key) return false;
  const CdrKey key = type_.cdr_key(message_in(sample));
  for (std::size_t i = 0; i < key.size(); ++i) handle.value[i] = key[i];
  return true;
}

RawType::RawType(const std::string& name, bool is_keyed) : DataType(name, is_keyed, kEncapsulationSize) {}

void* RawType::make_sample() { return new std::vector<std::uint8_t>; }

void RawType::delete_sample(void* sample) { delete &to_bytes(sample); }

std::uint32_t RawType::payload_size(const void* sample) {
  return static_cast<std::uint32_t>(to_bytes(sample).size());
}

bool RawType::write(const void* sample, Payload& payload) {
  const std::vector<std::uint8_t>& bytes = to_bytes(sample);
  if (bytes.size() > payload.max_size) return false;
  if (!bytes.empty()) std::memcpy(payload.data, bytes.data(), bytes.size());
  payload.length = static_cast<std::uint32_t>(bytes.size());
  payload.encapsulation = bytes.size() > 1 && bytes[1] == kBigEndianCdr ? CDR_BE : CDR_LE;
  return true;
}

bool RawType::read(const Payload& payload, void* sample) {
  to_bytes(sample).assign(payload.data, payload.data + payload.length);
  return true;
}

bool RawType::key(const void*, InstanceHandle_t& handle) {
  // The position of the key in the bytes is unknown. Unless the writer sends a hash of the key, all samples
  // belong to one instance.
  handle = InstanceHandle_t();
  handle.value[0] = 1;
  return true;
}

}  // namespace sidestep
