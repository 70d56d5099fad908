// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/topic_access.hpp"

#include <algorithm>
#include <string_view>

namespace sidestep {
namespace {

/// Whether the identity owns this robot's channel, if the topic has one per robot.
bool has_channel(const Identity& identity, const TopicInfo& topic, std::uint32_t robot) {
  const bool has_own = identity.role == Role::kAgent || identity.role == Role::kRobot;
  return !topic.per_robot || !has_own || identity.covers(robot);
}

}  // namespace

bool may_write(const Identity& identity, const TopicInfo& topic, std::uint32_t robot) {
  return topic.writers.has(identity.role) && has_channel(identity, topic, robot);
}

bool may_read(const Identity& identity, const TopicInfo& topic, std::uint32_t robot) {
  return topic.readers.has(identity.role) && has_channel(identity, topic, robot);
}

bool exchange_messages(const Identity& a, const Identity& b) {
  // For per-robot topics: an identity that is limited to its own channels may use the channels of the robots
  // `first` .. `last`.
  const std::uint32_t robots[] = {std::max(a.first, b.first), std::min(a.last, b.last), a.first, b.first};
  bool result = false;
  for_each_topic([&](const TopicInfo& topic) {
    if (std::string_view(topic.name) == topics::kRules.name) return;
    for (const std::uint32_t robot : robots)
      result = result || (may_write(a, topic, robot) && may_read(b, topic, robot)) ||
               (may_write(b, topic, robot) && may_read(a, topic, robot));
  });
  return result;
}

}  // namespace sidestep
