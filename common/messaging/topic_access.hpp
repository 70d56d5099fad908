// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/keys/identity.hpp"
#include "common/messaging/topics.hpp"

namespace sidestep {

/// Whether the identity may write or read a robot's channel of a topic. The robot is ignored for topics with
/// a single channel.
[[nodiscard]] bool may_write(const Identity& identity, const TopicInfo& topic, std::uint32_t robot);
[[nodiscard]] bool may_read(const Identity& identity, const TopicInfo& topic, std::uint32_t robot);
/// Whether either identity may write a topic that the other may read. The topic `rules` does not count: it is
/// exchanged only between processes that also exchange other messages.
[[nodiscard]] bool exchange_messages(const Identity& a, const Identity& b);

}  // namespace sidestep
