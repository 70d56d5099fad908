// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/topics.hpp"

#include <charconv>
#include <string_view>

#include "common/motion/version.hpp"

namespace sidestep {

std::vector<TopicInfo> all_topics() {
  std::vector<TopicInfo> topics;
  for_each_topic([&](const TopicInfo& topic) { topics.push_back(topic); });
  return topics;
}

std::optional<std::uint32_t> channel_robot(const TopicInfo& topic, const std::string& channel) {
  if (!topic.per_robot) return channel == topic.name ? std::optional<std::uint32_t>(0) : std::nullopt;
  const std::string prefix = std::string(topic.name) + "/";
  if (!channel.starts_with(prefix)) return std::nullopt;
  const std::string_view digits = std::string_view(channel).substr(prefix.size());
  std::uint32_t robot = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), robot);
  if (error != std::errc() || end != digits.data() + digits.size() || robot >= kMaxRobots)
    return std::nullopt;
  return robot;
}

void append_cdr(const TopicInfo& topic, const void* message, std::vector<std::uint8_t>& bytes) {
  const std::size_t begin = bytes.size();
  bytes.resize(begin + topic.type.cdr_size(message));
  bytes.resize(begin + topic.type.write_cdr(message, std::span(bytes).subspan(begin)));
}

bool read_cdr(const TopicInfo& topic, std::span<const std::uint8_t> bytes,
              const std::function<void(const void* message)>& use) {
  const std::shared_ptr<void> message = topic.type.make();
  if (!topic.type.read_cdr(bytes, ByteOrder::kLittleEndian, topic.type.max_elements, message.get()))
    return false;
  use(message.get());
  return true;
}

}  // namespace sidestep
