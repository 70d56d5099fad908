// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/topic_channel.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vector>

#include "common/file/similar_name.hpp"

namespace sidestep {

void print_unknown_topic(const std::string& channel) {
  std::vector<std::string> known;
  for (const TopicInfo& topic : all_topics())
    known.push_back(std::string(topic.name) + (topic.per_robot ? "/ROBOT" : ""));
  fmt::print(stderr, "unknown topic '{}'{}, expected one of: {}; another program's topic needs --idl\n",
             channel, did_you_mean(channel, known), fmt::join(known, " "));
}

void print_damage(const std::string& recording_file, const std::string& damage) {
  if (!damage.empty()) fmt::print(stderr, "{}: {}; earlier messages were used\n", recording_file, damage);
}

}  // namespace sidestep
