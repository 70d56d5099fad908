// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor/recorded_messages.hpp"

#include <algorithm>
#include <deque>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <variant>

#include "common/messaging/topics.hpp"
#include "deploy/inspect/time_range.hpp"
#include "deploy/inspect/topic/describe.hpp"
#include "deploy/view/monitor/inspected_message.hpp"

namespace sidestep {
namespace {

using Json = nlohmann::ordered_json;

std::optional<TopicInfo> topic_of(const std::string& channel) {
  for (const TopicInfo& topic : all_topics())
    if (channel_robot(topic, channel)) return topic;
  return std::nullopt;
}

/// Describes the bytes of a message; null if they are not a message of the topic.
Json describe_cdr(const TopicInfo& topic, std::span<const std::uint8_t> cdr) {
  Json json;
  const bool is_valid = read_cdr(topic, cdr, [&](const void* message) { json = describe(topic, message); });
  return is_valid ? json : Json();
}

}  // namespace

std::vector<std::string> RecordedMessages::between(const std::string& channel, Time from, Time to) {
  constexpr std::size_t kEncapsulation = 4;
  // The time by which messages may be out of order in the file.
  constexpr auto kDisorder = std::chrono::seconds(1);
  const std::optional<TopicInfo> topic = topic_of(channel);
  const auto& chunks = playback_.chunks();
  if (!topic || chunks.empty()) return {};
  const auto after =
      std::ranges::upper_bound(chunks, from - kDisorder, {}, &PlaybackBus::ChunkPosition::first_at);
  reader_.seek(playback_.reader(), (after == chunks.begin() ? after : std::prev(after))->offset);
  std::deque<std::string> messages;
  std::size_t bytes = 0;
  for (McapRecord record = reader_.next(); !std::holds_alternative<std::monostate>(record);
       record = reader_.next()) {
    const auto* message = std::get_if<McapMessage>(&record);
    if (message == nullptr) continue;
    const Time at =
        time_from_ns(static_cast<std::int64_t>(std::min<std::uint64_t>(message->logged_ns, kMaxTime_ns)));
    if (at > to + kDisorder) break;
    if (at <= from || at > to || message->payload.size() < kEncapsulation) continue;
    if (reader_.channel(*message).topic != channel) continue;
    Json json = describe_cdr(*topic, message->payload.subspan(kEncapsulation));
    if (json.is_null()) continue;
    messages.push_back(inspected_message(at, std::move(json)));
    bytes += messages.back().size();
    for (; bytes > kMaxBytes && messages.size() > 1; messages.pop_front()) bytes -= messages.front().size();
  }
  return {messages.begin(), messages.end()};
}

}  // namespace sidestep
