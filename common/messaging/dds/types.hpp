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

/// Fast DDS type support for one of our message types: the generated code, preceded by a check of the
/// payload, which is untrusted. Fast DDS's data pointers point to `Sample`s.
class GuardedType : public eprosima::fastdds::dds::TopicDataType {
 public:
  using Payload = eprosima::fastrtps::rtps::SerializedPayload_t;

  struct Sample {
    void* message = nullptr;  ///< points to a message of the type
    bool is_valid = true;     ///< false: the payload was refused and the message is unspecified
  };

  /// `max_elements` is the bound of the sequence that is the type's last member, 0: the type has none.
  GuardedType(std::unique_ptr<TopicDataType> generated, std::size_t max_elements);
  ~GuardedType() override;

  bool serialize(void* data, Payload* payload) override;
  /// Always true, so that Fast DDS delivers the sample; Sample::is_valid tells whether the payload was valid.
  bool deserialize(Payload* payload, void* data) override;
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override;
  void* createData() override;
  void deleteData(void* data) override;
  bool getKey(void* data, eprosima::fastrtps::rtps::InstanceHandle_t* handle, bool force_md5) override;

 private:
  bool is_acceptable(const Payload& payload) const;

  std::unique_ptr<TopicDataType> generated_;
  std::size_t max_elements_;
  std::size_t min_size_ = 0;  ///< of a payload, including the encapsulation header
  std::mutex key_mutex_;      ///< the generated getKey() uses a buffer of its object
};

/// Type support that keeps the payload's bytes, including the encapsulation header; for topics of any type
/// and vendor. Fast DDS's data pointers point to std::vector<std::uint8_t>.
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

/// Throws std::runtime_error if this program has no generated code for the type.
std::unique_ptr<GuardedType> make_dds_type(const MessageType& type);

}  // namespace sidestep
