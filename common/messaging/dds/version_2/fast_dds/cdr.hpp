// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <span>

/// Fast CDR 1 and the types that Fast DDS-Gen 2 generates.
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
             eprosima::fastcdr::Cdr::CORBA_CDR) {}

  /// These functions throw a std::exception if there are too few bytes or they do not encode such a message.
  template <typename Message>
  void write(const Message& message) {
    message.serialize(cdr_);
  }
  template <typename Message>
  void write_key(const Message& message) {
    message.serializeKey(cdr_);
  }
  template <typename Message>
  void read(Message& message) {
    message.deserialize(cdr_);
  }
  /// Number of bytes written or read so far.
  std::size_t position() const { return cdr_.getSerializedDataLength(); }

 private:
  eprosima::fastcdr::FastBuffer buffer_;
  eprosima::fastcdr::Cdr cdr_;
};

/// Number of bytes that the encoded message takes.
template <typename Message>
std::size_t cdr_size(const Message& message) {
  return Message::getCdrSerializedSize(message);
}

}  // namespace sidestep::fast_dds
