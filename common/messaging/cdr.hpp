// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "common/messaging/topics.hpp"

namespace sidestep {

/// Appends the message's CDR bytes, little-endian and without encapsulation header. `message` is of the
/// topic's type.
void append_cdr(const TopicInfo& topic, const void* message, std::vector<std::uint8_t>& bytes);

/// Reads a message of the topic's type from bytes that may come from anybody, and hands it over; false when
/// they are not such a message.
bool read_cdr(const TopicInfo& topic, std::span<const std::uint8_t> bytes,
              const std::function<void(const void* message)>& use);

}  // namespace sidestep
