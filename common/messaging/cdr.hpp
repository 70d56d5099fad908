// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace sidestep {

/// Appends the message's CDR bytes, little-endian, without an encapsulation header. `message` points to a
/// Message. Instantiated in cdr.cpp for the messages of all topics.
template <typename Message>
void append_cdr(const void* message, std::vector<std::uint8_t>& bytes);

/// Decodes untrusted bytes and passes the message, a Message, to `use`. Returns false if the bytes are not a
/// valid Message, or if its sequence has more than `max_elements` elements (0: the type has no sequence).
template <typename Message>
[[nodiscard]] bool read_cdr(std::span<const std::uint8_t> bytes, std::size_t max_elements,
                            const std::function<void(const void* message)>& use);

}  // namespace sidestep
