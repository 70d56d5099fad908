// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

#include "common/messaging/bus.hpp"

namespace sidestep {

/// Reports on stderr that a channel belongs to no topic, and lists the topics.
void print_unknown_topic(const std::string& channel);

/// Reports on stderr why only the beginning of a recording was used, if that is the case.
void print_damage(const std::string& recording_file, const std::string& damage);

/// Calls `use` with the topic and each message of a channel, including those that processes refuse. If the
/// channel belongs to no topic, calls print_unknown_topic() and returns false. Throws std::invalid_argument
/// if this process's keys do not allow reading it.
template <typename Use>
[[nodiscard]] bool subscribe_to_channel(Bus& bus, const std::string& channel, Use use) {
  bool is_known = false;
  for_each_topic([&]<typename Message>(const Topic<Message>& topic) {
    const auto robot = channel_robot(topic, channel);
    if (!robot) return;
    is_known = true;
    if (!bus.may_read(topic, *robot))
      throw std::invalid_argument("the keys of this process do not allow reading the topic '" + channel +
                                  "'");
    bus.observe<Message>(topic, *robot, [use, topic](const Message& message) { use(topic, message); });
  });
  if (!is_known) print_unknown_topic(channel);
  return is_known;
}

}  // namespace sidestep
