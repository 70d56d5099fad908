// SPDX-License-Identifier: Apache-2.0
#include "deploy/monitor/topic/topic_channel.hpp"

#include <charconv>
#include <fmt/core.h>
#include <string_view>

namespace sidestep {

std::optional<std::uint32_t> channel_robot(const TopicInfo& topic, const std::string& channel) {
  if (!topic.per_robot) return channel == topic.name ? std::optional<std::uint32_t>(0) : std::nullopt;
  const std::string prefix = std::string(topic.name) + "/";
  if (!channel.starts_with(prefix)) return std::nullopt;
  const std::string_view digits = std::string_view(channel).substr(prefix.size());
  std::uint32_t robot = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), robot);
  if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return robot;
}

void print_unknown_topic(const std::string& channel) {
  std::string known;
  for (const TopicInfo& topic : all_topics())
    known += std::string(known.empty() ? "" : " ") + topic.name + (topic.per_robot ? "/ROBOT" : "");
  fmt::print(stderr, "unknown topic '{}', expected one of: {}\n", channel, known);
}

void print_damage(const std::string& recording_file, const std::string& damage) {
  if (!damage.empty())
    fmt::print(stderr, "{}: {}; the messages before that were used\n", recording_file, damage);
}

}  // namespace sidestep
