// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/types.hpp"

#include <cstring>
#include <exception>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "idl/disturbancePubSubTypes.h"
#include "idl/monitorPubSubTypes.h"
#include "idl/negotiationPubSubTypes.h"
#include "idl/robotPubSubTypes.h"
#include "idl/visionPubSubTypes.h"

namespace sidestep {
namespace {

using eprosima::fastdds::dds::TopicDataType;
using eprosima::fastrtps::rtps::InstanceHandle_t;
using eprosima::fastrtps::rtps::SerializedPayload_t;

constexpr std::size_t kEncapsulationSize = 4;

GuardedType::Sample& to_sample(void* data) { return *static_cast<GuardedType::Sample*>(data); }
std::vector<std::uint8_t>& to_bytes(void* data) { return *static_cast<std::vector<std::uint8_t>*>(data); }

std::uint32_t read_uint32(const std::uint8_t* bytes, bool is_little_endian) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) {
    value |= std::uint32_t{bytes[i]} << (is_little_endian ? 8 * i : 24 - 8 * i);
  }
  return value;
}

template <typename Generated>
std::unique_ptr<TopicDataType> make_generated() {
  return std::make_unique<Generated>();
}

struct GeneratedType {
  const char* name;
  std::unique_ptr<TopicDataType> (*make)();
};

constexpr GeneratedType kGeneratedTypes[] = {
    {"sidestep::msg::CameraImage", make_generated<msg::CameraImagePubSubType>},
    {"sidestep::msg::DetectionFrame", make_generated<msg::DetectionFramePubSubType>},
    {"sidestep::msg::WorldState", make_generated<msg::WorldStatePubSubType>},
    {"sidestep::msg::Command", make_generated<msg::CommandPubSubType>},
    {"sidestep::msg::Feedback", make_generated<msg::FeedbackPubSubType>},
    {"sidestep::msg::Registration", make_generated<msg::RegistrationPubSubType>},
    {"sidestep::msg::Proposal", make_generated<msg::ProposalPubSubType>},
    {"sidestep::msg::Verdict", make_generated<msg::VerdictPubSubType>},
    {"sidestep::msg::LedgerPage", make_generated<msg::LedgerPagePubSubType>},
    {"sidestep::msg::CoordinatorState", make_generated<msg::CoordinatorStatePubSubType>},
    {"sidestep::msg::AgentStatus", make_generated<msg::AgentStatusPubSubType>},
    {"sidestep::msg::Disturbance", make_generated<msg::DisturbancePubSubType>},
    {"sidestep::msg::NetworkFault", make_generated<msg::NetworkFaultPubSubType>},
    {"sidestep::msg::GroundTruth", make_generated<msg::GroundTruthPubSubType>},
};

}  // namespace

GuardedType::GuardedType(std::unique_ptr<TopicDataType> generated, std::size_t max_elements)
    : generated_(std::move(generated)), max_elements_(max_elements) {
  setName(generated_->getName());
  m_isGetKeyDefined = generated_->m_isGetKeyDefined;
  auto_fill_type_object(false);
  auto_fill_type_information(false);
  void* empty = generated_->createData();
  min_size_ = generated_->getSerializedSizeProvider(empty)();
  generated_->deleteData(empty);
  // Initial size of the payloads in Fast DDS's pools, which grow on demand. The type's upper bound is often a
  // hundred times as large.
  m_typeSize = static_cast<std::uint32_t>(min_size_);
}

GuardedType::~GuardedType() = default;

bool GuardedType::serialize(void* data, Payload* payload) {
  return generated_->serialize(to_sample(data).message, payload);
}

bool GuardedType::deserialize(Payload* payload, void* data) {
  Sample& sample = to_sample(data);
  sample.is_valid = false;
  try {
    sample.is_valid = is_acceptable(*payload) && generated_->deserialize(payload, sample.message);
  } catch (const std::exception&) {
    // The generated code cannot read the payload: is_valid stays false.
  }
  return true;
}

bool GuardedType::is_acceptable(const Payload& payload) const {
  if (payload.data == nullptr || payload.length < min_size_) return false;
  const bool is_plain_cdr = payload.data[0] == 0 && payload.data[1] <= 1;
  if (!is_plain_cdr) return false;
  if (max_elements_ == 0) return true;
  // The sequence is the last member, so an empty message ends with its count.
  const std::uint8_t* count = payload.data + min_size_ - sizeof(std::uint32_t);
  return read_uint32(count, payload.data[1] == 1) <= max_elements_;
}

std::function<std::uint32_t()> GuardedType::getSerializedSizeProvider(void* data) {
  return generated_->getSerializedSizeProvider(to_sample(data).message);
}

void* GuardedType::createData() { return new Sample{generated_->createData(), true}; }

void GuardedType::deleteData(void* data) {
  generated_->deleteData(to_sample(data).message);
  delete static_cast<Sample*>(data);
}

bool GuardedType::getKey(void* data, InstanceHandle_t* handle, bool force_md5) {
  const std::lock_guard lock(key_mutex_);
  return generated_->getKey(to_sample(data).message, handle, force_md5);
}

RawType::RawType(const std::string& name, bool is_keyed) {
  setName(name.c_str());
  m_isGetKeyDefined = is_keyed;
  m_typeSize = kEncapsulationSize;
  auto_fill_type_object(false);
  auto_fill_type_information(false);
}

bool RawType::serialize(void* data, SerializedPayload_t* payload) {
  const std::vector<std::uint8_t>& bytes = to_bytes(data);
  if (bytes.size() > payload->max_size) return false;
  if (!bytes.empty()) std::memcpy(payload->data, bytes.data(), bytes.size());
  payload->length = static_cast<std::uint32_t>(bytes.size());
  payload->encapsulation = bytes.size() > 1 && bytes[1] == 0 ? CDR_BE : CDR_LE;
  return true;
}

bool RawType::deserialize(SerializedPayload_t* payload, void* data) {
  to_bytes(data).assign(payload->data, payload->data + payload->length);
  return true;
}

std::function<std::uint32_t()> RawType::getSerializedSizeProvider(void* data) {
  return [data] { return static_cast<std::uint32_t>(to_bytes(data).size()); };
}

void* RawType::createData() { return new std::vector<std::uint8_t>; }

void RawType::deleteData(void* data) { delete static_cast<std::vector<std::uint8_t>*>(data); }

bool RawType::getKey(void*, InstanceHandle_t* handle, bool) {
  // The position of the key in the bytes is unknown. Unless the writer sends the key's hash, all samples
  // belong to one instance.
  *handle = InstanceHandle_t();
  handle->value[0] = 1;
  return true;
}

std::unique_ptr<GuardedType> make_dds_type(const MessageType& type) {
  for (const GeneratedType& generated : kGeneratedTypes) {
    if (std::string_view(generated.name) == type.name) {
      return std::make_unique<GuardedType>(generated.make(), type.max_elements);
    }
  }
  throw std::runtime_error(std::string("no generated code for the message type ") + type.name);
}

}  // namespace sidestep
