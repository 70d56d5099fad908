// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/rtps/common/InstanceHandle.hpp>
#include <fastdds/rtps/common/SerializedPayload.hpp>
#include <string>

#include "fast_dds/library.hpp"

namespace sidestep::fast_dds {

/// Base class of our type supports, with the same virtual functions for every version of Fast DDS. Fast DDS's
/// `data` pointers point to samples of the derived class.
class DataType : public dds::TopicDataType {
 public:
  using Payload = rtps::SerializedPayload_t;

  /// `initial_size` is the initial size of payloads in Fast DDS's pools, which grow on demand.
  DataType(const std::string& name, bool is_keyed, std::uint32_t initial_size) {
    set_name(name);
    is_compute_key_provided = is_keyed;
    max_serialized_type_size = initial_size;
  }

  virtual void* make_sample() = 0;
  virtual void delete_sample(void* sample) = 0;
  /// Number of bytes in the sample's payload, including the encapsulation header.
  virtual std::uint32_t payload_size(const void* sample) = 0;
  [[nodiscard]] virtual bool write(const void* sample, Payload& payload) = 0;
  [[nodiscard]] virtual bool read(const Payload& payload, void* sample) = 0;
  [[nodiscard]] virtual bool key(const void* sample, rtps::InstanceHandle_t& handle) = 0;

  std::string name() const { return get_name(); }
  bool is_keyed() const { return is_compute_key_provided; }

  void* create_data() final { return make_sample(); }
  void delete_data(void* sample) final { delete_sample(sample); }
  std::uint32_t calculate_serialized_size(const void* sample, dds::DataRepresentationId_t) final {
    return payload_size(sample);
  }
  bool serialize(const void* sample, Payload& payload, dds::DataRepresentationId_t) final {
    return write(sample, payload);
  }
  bool deserialize(Payload& payload, void* sample) final { return read(payload, sample); }
  bool compute_key(const void* sample, rtps::InstanceHandle_t& handle, bool) final {
    return key(sample, handle);
  }
  /// Called if a writer from another vendor does not send a hash of the key.
  bool compute_key(Payload& payload, rtps::InstanceHandle_t& handle, bool) final {
    void* sample = make_sample();
    const bool has_key = read(payload, sample) && key(sample, handle);
    delete_sample(sample);
    return has_key;
  }
};

}  // namespace sidestep::fast_dds
