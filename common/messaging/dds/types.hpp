// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "common/messaging/topics.hpp"
#include "fast_dds/data_type.hpp"

namespace sidestep {

/// Fast DDS type support for one of our message types. Payloads are untrusted. Fast DDS sees samples of the
/// type `Sample`.
class GuardedType : public fast_dds::DataType {
 public:
  struct Sample {
    void* message = nullptr;  ///< points to a message of the type
    bool is_valid = true;     ///< false: the payload was refused and the message is unspecified
  };

  explicit GuardedType(const MessageType& type);

  void* make_sample() override;
  void delete_sample(void* sample) override;
  std::uint32_t payload_size(const void* sample) override;
  bool write(const void* sample, Payload& payload) override;
  /// Always true, so that Fast DDS delivers the sample; Sample::is_valid tells whether the payload was valid.
  bool read(const Payload& payload, void* sample) override;
  bool key(const void* sample, fast_dds::rtps::InstanceHandle_t& handle) override;

 private:
  MessageType type_;
};

/// Type support that keeps the payload's bytes, including the encapsulation header; for topics of any type
/// and vendor. Samples are std::vector<std::uint8_t>.
class RawType : public fast_dds::DataType {
 public:
  RawType(const std::string& name, bool is_keyed);

  void* make_sample() override;
  void delete_sample(void* sample) override;
  std::uint32_t payload_size(const void* sample) override;
  bool write(const void* sample, Payload& payload) override;
  bool read(const Payload& payload, void* sample) override;
  bool key(const void* sample, fast_dds::rtps::InstanceHandle_t& handle) override;
};

}  // namespace sidestep
