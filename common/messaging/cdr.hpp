// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "fast_dds/cdr.hpp"

namespace sidestep {

using ByteOrder = fast_dds::ByteOrder;

/// The CDR bytes of a key, big-endian and padded with zeros.
using CdrKey = std::array<std::uint8_t, 16>;

/// The templates below are instantiated only in cdr.cpp, for the messages of all topics, to save compile
/// time. Each `message` points to a Message. Bytes have no encapsulation header.

template <typename Message>
std::shared_ptr<void> make_message();

template <typename Message>
std::shared_ptr<const void> copy_message(const void* message);

/// The message's Header.sender.
template <typename Message>
std::uint32_t message_sender(const void* message);

template <typename Message>
std::size_t cdr_size(const void* message);

/// Writes the message's CDR bytes, little-endian, and returns their number; 0 if there is not enough space.
template <typename Message>
[[nodiscard]] std::size_t write_cdr(const void* message, std::span<std::uint8_t> bytes);

template <typename Message>
CdrKey cdr_key(const void* message);

/// Decodes untrusted bytes, which may end with up to three bytes of padding. False if the bytes are not a
/// valid Message, or if its sequence has more than `max_elements` elements (0: the type has no sequence); the
/// message is then unspecified.
template <typename Message>
[[nodiscard]] bool read_cdr(std::span<const std::uint8_t> bytes, ByteOrder order, std::size_t max_elements,
                            void* message);

}  // namespace sidestep
