// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "common/messaging/topics.hpp"

namespace sidestep {

/// What Fast DDS sees of one of our message types: the generated code with a guard before it, because the
/// payload may come from anybody. The data that Fast DDS passes round are `Sample`s.
class GuardedType : public eprosima::fastdds::dds::TopicDataType {
 public:
  using Payload = eprosima::fastrtps::rtps::SerializedPayload_t;

  struct Sample {
    void* message = nullptr;  ///< of the message type
    bool is_valid = true;     ///< false: the payload was refused, and the message is unspecified
  };

  /// `max_elements` bounds the sequence at the type's end, 0: the type has none.
  GuardedType(std::unique_ptr<TopicDataType> generated, std::size_t max_elements);
  ~GuardedType() override;

  bool serialize(void* data, Payload* payload) override;
  /// Always true, so that Fast DDS hands the sample on; what it says of the payload is Sample::is_valid.
  bool deserialize(Payload* payload, void* data) override;
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override;
  void* createData() override;
  void deleteData(void* data) override;
  bool getKey(void* data, eprosima::fastrtps::rtps::InstanceHandle_t* handle, bool force_md5) override;

 private:
  bool is_acceptable(const Payload& payload) const;

  std::unique_ptr<TopicDataType> generated_;
  std::size_t max_elements_;
  std::size_t smallest_size_ = 0;  ///< of a payload, its encapsulation header included
  std::mutex key_mutex_;           ///< the generated getKey() works in a buffer of its object
};

/// Keeps the payload's bytes as they are, its encapsulation header included; for topics of any type and
/// vendor. The data are std::vector<std::uint8_t>.
class RawType : public eprosima::fastdds::dds::TopicDataType {
 public:
  RawType(const std::string& name, bool is_keyed);

  bool serialize(void* data, eprosima::fastrtps::rtps::SerializedPayload_t* payload) override;
  bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* data) override;
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override;
  void* createData() override;
  void deleteData(void* data) override;
  bool getKey(void* data, eprosima::fastrtps::rtps::InstanceHandle_t* handle, bool force_md5) override;
};

/// Throws std::runtime_error for a type that this program has no generated code for.
std::unique_ptr<GuardedType> make_dds_type(const MessageType& type);

}  // namespace sidestep
