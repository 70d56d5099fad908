// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/league/decode_error.hpp"

namespace sidestep::league {

/// Serialises a Protobuf message.
template <typename Message>
std::vector<std::byte> bytes_of(const Message& message) {
  std::vector<std::byte> bytes(message.ByteSizeLong());
  message.SerializeWithCachedSizesToArray(reinterpret_cast<std::uint8_t*>(bytes.data()));
  return bytes;
}

/// Parses a Protobuf message from a datagram.
template <typename Message>
[[nodiscard]] DecodeError parse(std::span<const std::byte> bytes, Message& message) {
  if (bytes.size() > kMaxDatagramSize) return DecodeError::kTooLong;
  if (bytes.empty()) return DecodeError::kEmpty;
  // ParseFromArray() would print a line for every message that lacks a required field.
  const bool is_parsed = message.ParsePartialFromArray(bytes.data(), static_cast<int>(bytes.size()));
  return is_parsed && message.IsInitialized() ? DecodeError::kNone : DecodeError::kMalformed;
}

}  // namespace sidestep::league
