// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/record/playback_bus.hpp"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <stdexcept>
#include <utility>
#include <variant>

#include "common/config/scenario_loader.hpp"
#include "common/file/temporary_folder.hpp"
#include "common/file/write_file.hpp"
#include "common/map/map_file.hpp"
#include "common/messaging/cdr.hpp"
#include "deploy/inspect/time_range.hpp"

namespace sidestep {
namespace {

/// The key contains the type, so a subscriber never gets a message of another type, even from a corrupt file.
std::string reader_key(const TopicInfo& topic, const std::string& channel) {
  return std::string(topic.type.name) + ' ' + channel;
}

std::string text_of(const McapAttachment& attachment) {
  return {attachment.content.begin(), attachment.content.end()};
}

std::shared_ptr<const OccupancyMap> map_of(const MapFiles& files) {
  const TemporaryFolder folder;
  write_file(folder.file(kMapFile), files.yaml);
  write_file(folder.file(kMapImageFile), files.image);
  return std::make_shared<const OccupancyMap>(load_map(folder.file(kMapFile)).cells);
}

}  // namespace

PlaybackBus::PlaybackBus(const std::string& path) : reader_(path) { read_header(path); }

void PlaybackBus::read_header(const std::string& path) {
  bool is_ours = false, has_scenario = false;
  MapFiles map;
  for (;;) {
    next_ = reader_.next();
    if (const auto* metadata = std::get_if<McapMetadata>(&next_)) {
      if (metadata->name == kEventMetadata) early_events_.push_back(*metadata);
      if (metadata->name != kRecordingMetadata) continue;
      is_ours = true;
      const auto text = [&](const char* key) {
        const auto found = metadata->texts.find(key);
        return found == metadata->texts.end() ? std::string() : found->second;
      };
      header_.scenario_name = text("scenario");
      header_.is_complete = text("complete") == "true";
    } else if (const auto* attachment = std::get_if<McapAttachment>(&next_)) {
      if (attachment->name == kScenarioFile) {
        header_.scenario_text = text_of(*attachment);
        has_scenario = true;
      }
      if (attachment->name == kMapFile) map.yaml = text_of(*attachment);
      if (attachment->name == kMapImageFile) map.image = text_of(*attachment);
    } else {
      break;
    }
  }
  if (!is_ours || !has_scenario)
    throw std::invalid_argument(fmt::format("{}: {}", path,
                                            reader_.damage().empty()
                                                ? "is not a recording of Sidestep"
                                                : "the beginning is damaged: " + reader_.damage()));
  try {
    if (!map.yaml.empty()) header_.map = map_of(map);
  } catch (const std::exception& error) {
    throw std::invalid_argument(fmt::format("{}: the recorded map: {}", path, error.what()));
  }
}

Scenario PlaybackBus::scenario() const {
  if (header_.scenario_text.empty())
    throw std::invalid_argument(
        "the recording contains no scenario, because it shows a random scene; only MCAP viewers can show it");
  return parse_scenario(header_.scenario_text, header_.scenario_name + ".yaml", header_.map.get());
}

void PlaybackBus::deliver_event(const McapMetadata& metadata) {
  if (metadata.name != kEventMetadata || !on_event_) return;
  const auto text = [&](const char* key) {
    const auto found = metadata.texts.find(key);
    return found == metadata.texts.end() ? std::string() : found->second;
  };
  const std::string at = text("at_ns");
  std::int64_t at_ns = 0;
  const auto end = std::from_chars(at.data(), at.data() + at.size(), at_ns);
  if (end.ec == std::errc() && end.ptr == at.data() + at.size() && at_ns >= 0 && at_ns < kMaxTime_ns)
    on_event_(time_from_ns(at_ns), text("kind"), text("text"));
}

bool PlaybackBus::play_next(PlaybackResult& result) {
  for (const McapMetadata& event : std::exchange(early_events_, {})) deliver_event(event);
  while (!is_stopped_ && !std::holds_alternative<std::monostate>(next_)) {
    const auto* message = std::get_if<McapMessage>(&next_);
    const bool is_readable = message == nullptr || deliver(*message, result);
    const bool was_message = message != nullptr;
    if (const auto* metadata = std::get_if<McapMetadata>(&next_)) deliver_event(*metadata);
    if (!is_readable) {
      is_stopped_ = true;
      return false;
    }
    next_ = reader_.next();
    if (was_message) return true;
  }
  if (result.damage.empty()) result.damage = reader_.damage();
  return false;
}

PlaybackResult PlaybackBus::play() {
  PlaybackResult result;
  while (play_next(result)) {
  }
  return result;
}

const TopicInfo* PlaybackBus::topic_of(const McapMessage& message) {
  const auto known = topic_of_channel_.find(message.channel);
  if (known != topic_of_channel_.end()) return known->second;
  const McapChannel& channel = reader_.channel(message);
  const McapSchema* schema = reader_.schema(channel);
  const auto is_of = [&](const TopicInfo& topic) {
    const std::string name = topic.name;
    return schema != nullptr && schema->name == topic.type.name && channel.message_encoding == "cdr" &&
           (topic.per_robot ? channel.topic.starts_with(name + '/') : channel.topic == name);
  };
  const auto found = std::ranges::find_if(topics_, is_of);
  return topic_of_channel_[message.channel] = found == topics_.end() ? nullptr : &*found;
}

bool PlaybackBus::deliver(const McapMessage& message, PlaybackResult& result) {
  constexpr std::size_t kEncapsulationSize = 4;
  const TopicInfo* topic = topic_of(message);
  if (topic == nullptr) return true;
  if (message.logged_ns >= static_cast<std::uint64_t>(kMaxTime_ns)) {
    result.damage = "a message has no valid time";
    return false;
  }
  now_ = time_from_ns(static_cast<std::int64_t>(message.logged_ns));
  if (chunks_.empty() || chunks_.back().offset != reader_.chunk_offset())
    chunks_.push_back({now_, reader_.chunk_offset()});
  ++result.messages;
  const auto readers = readers_.find(reader_key(*topic, reader_.channel(message).topic));
  const auto use = [&](const void* decoded) {
    if (readers == readers_.end()) return;
    for (const auto& callback : readers->second) callback(decoded);
  };
  const bool is_little_endian =
      message.payload.size() >= kEncapsulationSize && message.payload[0] == 0 && message.payload[1] == 1;
  if (!is_little_endian || !read_cdr(*topic, message.payload.subspan(kEncapsulationSize), use))
    ++result.unreadable;
  return true;
}

std::unique_ptr<RawWriter> PlaybackBus::make_writer(const TopicInfo&, const std::string&) {
  struct NullWriter : RawWriter {
    void write(const void*) override {}
  };
  return std::make_unique<NullWriter>();
}

void PlaybackBus::make_reader(const TopicInfo& topic, const std::string& channel,
                              std::function<void(const void*)> callback) {
  readers_[reader_key(topic, channel)].push_back(std::move(callback));
}

}  // namespace sidestep
