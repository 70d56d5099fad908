// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/topic_channel.hpp"

#include <fmt/core.h>

namespace sidestep {

void print_unknown_topic(const std::string& channel) {
  std::string known;
  for (const TopicInfo& topic : all_topics())
    known += std::string(known.empty() ? "" : " ") + topic.name + (topic.per_robot ? "/ROBOT" : "");
  fmt::print(stderr, "unknown topic '{}', expected one of: {}\n", channel, known);
}

void print_damage(const std::string& recording_file, const std::string& damage) {
  if (!damage.empty()) fmt::print(stderr, "{}: {}; earlier messages were used\n", recording_file, damage);
}

}  // namespace sidestep
