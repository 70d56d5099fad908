// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/league/refusal.hpp"

namespace sidestep::league {

/// A Protobuf message as bytes.
template <typename Message>
std::vector<std::byte> bytes_of(const Message& message) {
  std::vector<std::byte> bytes(message.ByteSizeLong());
  message.SerializeWithCachedSizesToArray(reinterpret_cast<std::uint8_t*>(bytes.data()));
  return bytes;
}

/// Reads a Protobuf message of a datagram.
template <typename Message>
Refusal parse(std::span<const std::byte> bytes, Message& message) {
  if (bytes.size() > kLongestDatagram) return Refusal::kTooLong;
  if (bytes.empty()) return Refusal::kEmpty;
  // ParseFromArray() would print a line about every message that lacks a field.
  const bool is_read = message.ParsePartialFromArray(bytes.data(), static_cast<int>(bytes.size()));
  return is_read && message.IsInitialized() ? Refusal::kNone : Refusal::kMalformed;
}

}  // namespace sidestep::league
