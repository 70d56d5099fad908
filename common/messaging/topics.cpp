// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/topics.hpp"

namespace sidestep {

std::vector<TopicInfo> all_topics() {
  std::vector<TopicInfo> topics;
  for_each_topic([&](const TopicInfo& topic) { topics.push_back(topic); });
  return topics;
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
