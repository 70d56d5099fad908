// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <fastcdr/Cdr.h>
#include <fastcdr/CdrSizeCalculator.hpp>
#include <fastcdr/FastBuffer.h>
#include <span>

#include "idl/clockCdrAux.hpp"
#include "idl/disturbanceCdrAux.hpp"
#include "idl/laserCdrAux.hpp"
#include "idl/monitorCdrAux.hpp"
#include "idl/negotiationCdrAux.hpp"
#include "idl/orderCdrAux.hpp"
#include "idl/robotCdrAux.hpp"
#include "idl/rulesCdrAux.hpp"
#include "idl/visionCdrAux.hpp"

/// Fast CDR 2 and the types that Fast DDS-Gen 4 generates. They use the same encoding as version 2 (XCDR 1).
namespace sidestep::fast_dds {

enum class ByteOrder : std::uint8_t { kLittleEndian, kBigEndian };

/// A coder over these bytes. The library takes mutable bytes even for reading.
class CdrCoder {
 public:
  CdrCoder(std::span<const std::uint8_t> bytes, ByteOrder order)
      : buffer_(reinterpret_cast<char*>(const_cast<std::uint8_t*>(bytes.data())), bytes.size()),
        cdr_(buffer_,
             order == ByteOrder::kBigEndian ? eprosima::fastcdr::Cdr::BIG_ENDIANNESS
                                            : eprosima::fastcdr::Cdr::LITTLE_ENDIANNESS,
             eprosima::fastcdr::CdrVersion::XCDRv1) {
    cdr_.set_encoding_flag(eprosima::fastcdr::EncodingAlgorithmFlag::PLAIN_CDR);
  }

  /// These functions throw a std::exception if there are too few bytes or they do not encode such a message.
  template <typename Message>
  void write(const Message& message) {
    eprosima::fastcdr::serialize(cdr_, message);
  }
  template <typename Message>
  void write_key(const Message& message) {
    eprosima::fastcdr::serialize_key(cdr_, message);
  }
  template <typename Message>
  void read(Message& message) {
    eprosima::fastcdr::deserialize(cdr_, message);
  }
  /// Number of bytes written or read so far.
  std::size_t position() const { return cdr_.get_serialized_data_length(); }

 private:
  eprosima::fastcdr::FastBuffer buffer_;
  eprosima::fastcdr::Cdr cdr_;
};

/// Number of bytes that the encoded message takes.
template <typename Message>
std::size_t cdr_size(const Message& message) {
  eprosima::fastcdr::CdrSizeCalculator calculator(eprosima::fastcdr::CdrVersion::XCDRv1);
  std::size_t alignment = 0;
  return calculator.calculate_serialized_size(message, alignment);
}

}  // namespace sidestep::fast_dds
