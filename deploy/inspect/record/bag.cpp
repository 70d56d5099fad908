// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/record/bag.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>
#include <variant>

#include "deploy/inspect/record/mcap/mcap_reader.hpp"
#include "deploy/inspect/record/mcap/mcap_writer.hpp"
#include "deploy/inspect/record/recording.hpp"

namespace sidestep {
namespace {

bool is_end(const McapRecord& record) { return std::holds_alternative<std::monostate>(record); }

/// Copies records of one or several files to another one.
class Copier {
 public:
  explicit Copier(const std::string& path) : writer_(path) {}

  void copy(const McapReader& reader, const McapMessage& message) {
    McapMessage copied = message;
    copied.channel = channel_id(reader, message);
    writer_.add_message(copied, [&](McapBytes& bytes) {
      bytes.insert(bytes.end(), message.payload.begin(), message.payload.end());
    });
  }
  /// Skips an attachment that has already been copied.
  void copy(const McapAttachment& attachment) {
    if (attachments_.emplace(attachment.name, attachment.content).second) writer_.add_attachment(attachment);
  }
  void copy(const McapMetadata& metadata) {
    if (metadata_.insert({metadata.name, metadata.texts}).second) writer_.add_metadata(metadata);
  }
  bool has_failed() const { return !writer_.failure().empty(); }
  /// Throws std::runtime_error if any write has failed.
  void close() { writer_.close(); }

 private:
  std::uint16_t channel_id(const McapReader& reader, const McapMessage& message) {
    const auto [id, is_new] = ids_.try_emplace({&reader, message.channel}, std::uint16_t{0});
    if (!is_new) return id->second;
    McapChannel channel = reader.channel(message);
    if (const McapSchema* schema = reader.schema(channel)) {
      const auto [schema_id, is_new_schema] =
          schemas_.try_emplace({schema->name, schema->text}, std::uint16_t{0});
      if (is_new_schema) schema_id->second = writer_.add_schema(*schema);
      channel.schema = schema_id->second;
    }
    const auto same = std::ranges::find_if(channels_, [&](const auto& known) {
      return known.second.schema == channel.schema && known.second.topic == channel.topic &&
             known.second.message_encoding == channel.message_encoding;
    });
    if (same != channels_.end()) return id->second = same->first;
    id->second = writer_.add_channel(channel);
    channels_.emplace(id->second, channel);
    return id->second;
  }

  McapWriter writer_;
  std::map<std::pair<const McapReader*, std::uint16_t>, std::uint16_t> ids_;
  std::map<std::pair<std::string, std::string>, std::uint16_t> schemas_;  // indexed by name and text
  std::map<std::uint16_t, McapChannel> channels_;
  std::set<std::pair<std::string, McapBytes>> attachments_;
  std::set<std::pair<std::string, std::map<std::string, std::string>>> metadata_;
};

/// Marks a recording as incomplete, because a cut or merged recording lacks messages of the run.
void mark_incomplete(McapMetadata& metadata) {
  if (metadata.name == kRecordingMetadata) metadata.texts["complete"] = "false";
}

/// The scenario that is attached before the first message.
std::optional<McapBytes> recorded_scenario(const std::string& path) {
  McapReader reader(path);
  for (McapRecord record = reader.next();; record = reader.next()) {
    if (const auto* attachment = std::get_if<McapAttachment>(&record)) {
      if (attachment->name == kScenarioFile) return attachment->content;
    } else if (!std::holds_alternative<McapMetadata>(record)) {
      return std::nullopt;
    }
  }
}

/// Throws std::invalid_argument if two recordings have different scenarios.
void require_same_scenario(const std::vector<std::string>& paths) {
  std::optional<McapBytes> first;
  for (const std::string& path : paths) {
    const std::optional<McapBytes> scenario = recorded_scenario(path);
    if (first && scenario && *scenario != *first)
      throw std::invalid_argument(path +
                                  ": this recording is of a different scenario than the files before it");
    if (scenario) first = scenario;
  }
}

bool is_chosen(const std::set<std::string>& topics, const std::string& channel) {
  return topics.empty() || topics.contains(channel) || topics.contains(channel.substr(0, channel.rfind('/')));
}

}  // namespace

namespace {

/// The event as a line, for example "12.345 s: bookmark: here".
std::string event_line(const McapMetadata& event) {
  const auto text = [&](const char* key) {
    const auto found = event.texts.find(key);
    return found == event.texts.end() ? std::string("?") : found->second;
  };
  const std::string at = text("at_ns");
  return fmt::format("{:.3f} s: {}: {}", std::strtod(at.c_str(), nullptr) * 1e-9, text("kind"), text("text"));
}

}  // namespace

BagInfo bag_info(const std::string& path) {
  McapReader reader(path);
  BagInfo info;
  std::error_code error;
  info.file_bytes = std::filesystem::file_size(path, error);
  for (McapRecord record = reader.next(); !is_end(record); record = reader.next()) {
    if (const auto* message = std::get_if<McapMessage>(&record)) {
      const McapChannel& channel = reader.channel(*message);
      const auto [entry, is_new] = info.channels.try_emplace(channel.topic);
      BagInfo::Channel& counts = entry->second;
      if (is_new) {
        const McapSchema* schema = reader.schema(channel);
        counts.type = schema ? schema->name : "-";
        counts.first_ns = message->logged_ns;
      }
      counts.last_ns = message->logged_ns;
      counts.bytes += message->payload.size();
      ++counts.messages;
      info.first_ns = info.messages == 0 ? message->logged_ns : std::min(info.first_ns, message->logged_ns);
      info.last_ns = std::max(info.last_ns, message->logged_ns);
      ++info.messages;
    } else if (const auto* attachment = std::get_if<McapAttachment>(&record)) {
      info.attachments.push_back(fmt::format("{} ({}), {} bytes", attachment->name, attachment->media_type,
                                             attachment->content.size()));
    } else if (const auto* metadata = std::get_if<McapMetadata>(&record)) {
      if (metadata->name == kEventMetadata) {
        info.events.push_back(event_line(*metadata));
        continue;
      }
      for (const auto& [key, value] : metadata->texts) info.metadata[metadata->name + "." + key] = value;
    }
  }
  info.damage = reader.damage();
  return info;
}

std::string to_text(const BagInfo& info) {
  const auto seconds = [](std::uint64_t ns) { return static_cast<double>(ns) * 1e-9; };
  std::string text = fmt::format("{:.1f} MB, {} messages, {:.3f} s from {:.3f} s\n",
                                 static_cast<double>(info.file_bytes) * 1e-6, info.messages,
                                 seconds(info.last_ns - info.first_ns), seconds(info.first_ns));
  for (const auto& [key, value] : info.metadata) text += fmt::format("{}: {}\n", key, value);
  for (const std::string& attachment : info.attachments) text += fmt::format("attachment: {}\n", attachment);
  for (const std::string& event : info.events) text += fmt::format("event at {}\n", event);
  std::size_t topic_width = 5, type_width = 4;
  for (const auto& [topic, channel] : info.channels) {
    topic_width = std::max(topic_width, topic.size());
    type_width = std::max(type_width, channel.type.size());
  }
  text += fmt::format("{:{}}  {:{}}  {:>9}  {:>8}  {:>8}\n", "TOPIC", topic_width, "TYPE", type_width,
                      "MESSAGES", "HZ", "KB");
  for (const auto& [topic, channel] : info.channels) {
    const double duration_s = seconds(channel.last_ns - std::min(channel.first_ns, channel.last_ns));
    const std::string rate =
        duration_s > 0 ? fmt::format("{:.1f}", static_cast<double>(channel.messages - 1) / duration_s) : "-";
    text += fmt::format("{:{}}  {:{}}  {:>9}  {:>8}  {:>8.1f}\n", topic, topic_width, channel.type,
                        type_width, channel.messages, rate, static_cast<double>(channel.bytes) * 1e-3);
  }
  return text;
}

namespace {

/// Whether a message belongs to the part. `begin_ns`: when the first message of the file was logged.
bool is_in(const BagCut& cut, const McapReader& reader, const McapMessage& message, std::uint64_t begin_ns) {
  const double at_s = (static_cast<double>(message.logged_ns) - static_cast<double>(begin_ns)) * 1e-9;
  return at_s >= cut.from_s && at_s <= cut.to_s && is_chosen(cut.topics, reader.channel(message).topic);
}

/// Throws std::invalid_argument that says what the file has if nothing of it would be left.
void require_message(const std::string& path, const BagCut& cut) {
  McapReader reader(path);
  std::optional<std::uint64_t> begin_ns;
  std::uint64_t messages = 0, end_ns = 0;
  std::set<std::string> topics;
  for (McapRecord record = reader.next(); !is_end(record); record = reader.next()) {
    const auto* message = std::get_if<McapMessage>(&record);
    if (message == nullptr) continue;
    if (!begin_ns) begin_ns = message->logged_ns;
    if (is_in(cut, reader, *message, *begin_ns)) return;
    end_ns = std::max(end_ns, message->logged_ns);
    topics.insert(reader.channel(*message).topic);
    ++messages;
  }
  if (messages == 0) throw std::invalid_argument(path + ": the recording has no messages");
  throw std::invalid_argument(fmt::format(
      "no message is left, so nothing is written: {} has {} messages in {:.3f} s, of the topics {}", path,
      messages, static_cast<double>(end_ns - *begin_ns) * 1e-9, fmt::join(topics, ", ")));
}

}  // namespace

std::string cut_bag(const std::string& path, const BagCut& cut, const std::string& out) {
  require_message(path, cut);
  McapReader reader(path);
  Copier copier(out);
  std::optional<std::uint64_t> begin_ns;
  for (McapRecord record = reader.next(); !is_end(record) && !copier.has_failed(); record = reader.next()) {
    if (const auto* message = std::get_if<McapMessage>(&record)) {
      if (!begin_ns) begin_ns = message->logged_ns;
      if (is_in(cut, reader, *message, *begin_ns)) copier.copy(reader, *message);
    } else if (const auto* attachment = std::get_if<McapAttachment>(&record)) {
      copier.copy(*attachment);
    } else if (auto* metadata = std::get_if<McapMetadata>(&record)) {
      mark_incomplete(*metadata);
      copier.copy(*metadata);
    }
  }
  copier.close();
  return reader.damage();
}

std::string merge_bags(const std::vector<std::string>& paths, const std::string& out) {
  struct Source {
    McapReader reader;
    McapRecord record;
  };
  require_same_scenario(paths);
  Copier copier(out);
  std::vector<std::unique_ptr<Source>> sources;
  // Also copies what precedes the first message, because playback expects it there.
  const auto advance = [&](Source& source) {
    for (;;) {
      source.record = source.reader.next();
      if (auto* metadata = std::get_if<McapMetadata>(&source.record)) {
        mark_incomplete(*metadata);
        copier.copy(*metadata);
      } else if (const auto* attachment = std::get_if<McapAttachment>(&source.record)) {
        copier.copy(*attachment);
      } else {
        return;
      }
    }
  };
  for (const std::string& path : paths) {
    sources.push_back(std::make_unique<Source>(Source{McapReader(path), {}}));
    advance(*sources.back());
  }
  const auto time_of = [](const std::unique_ptr<Source>& source) {
    const auto* message = std::get_if<McapMessage>(&source->record);
    return message ? message->logged_ns : std::numeric_limits<std::uint64_t>::max();
  };
  for (;;) {
    Source& next = **std::ranges::min_element(sources, {}, time_of);
    const auto* message = std::get_if<McapMessage>(&next.record);
    if (message == nullptr || copier.has_failed()) break;
    copier.copy(next.reader, *message);
    advance(next);
  }
  copier.close();
  std::string damages;
  for (std::size_t i = 0; i < paths.size(); ++i)
    if (!sources[i]->reader.damage().empty())
      damages += fmt::format("{}{}: {}", damages.empty() ? "" : "; ", paths[i], sources[i]->reader.damage());
  return damages;
}

}  // namespace sidestep
