// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <functional>
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
    setName(name.c_str());
    m_isGetKeyDefined = is_keyed;
    m_typeSize = initial_size;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }

  virtual void* make_sample() = 0;
  virtual void delete_sample(void* sample) = 0;
  /// Number of bytes in the sample's payload, including the encapsulation header.
  virtual std::uint32_t payload_size(const void* sample) = 0;
  [[nodiscard]] virtual bool write(const void* sample, Payload& payload) = 0;
  [[nodiscard]] virtual bool read(const Payload& payload, void* sample) = 0;
  [[nodiscard]] virtual bool key(const void* sample, rtps::InstanceHandle_t& handle) = 0;

  std::string name() const { return getName(); }
  bool is_keyed() const { return m_isGetKeyDefined; }

  void* createData() final { return make_sample(); }
  void deleteData(void* sample) final { delete_sample(sample); }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* sample) final {
    return [this, sample] { return payload_size(sample); };
  }
  bool serialize(void* sample, Payload* payload) final { return write(sample, *payload); }
  bool deserialize(Payload* payload, void* sample) final { return read(*payload, sample); }
  bool getKey(void* sample, rtps::InstanceHandle_t* handle, bool) final { return key(sample, *handle); }
};

}  // namespace sidestep::fast_dds
