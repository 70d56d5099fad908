// SPDX-License-Identifier: Apache-2.0
// Fuzzes the reader of recordings.
#include <set>
#include <stdexcept>

#include "common/file/temporary_folder.hpp"
#include "common/yaml/config_error.hpp"
#include "deploy/inspect/record/bag.hpp"
#include "deploy/inspect/record/mcap/mcap_writer.hpp"
#include "deploy/inspect/record/playback_bus.hpp"
#include "deploy/inspect/time_range.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace sidestep::fuzz {
namespace {

/// Encodes a decoded message; decoding the result must give the same message.
template <typename Message>
void check_message(const TopicInfo& topic, const Message& message) {
  Bytes bytes, again;
  append_cdr(topic, &message, bytes);
  const bool is_read =
      read_cdr(topic, bytes, [&](const void* decoded) { append_cdr(topic, decoded, again); });
  SIDESTEP_REQUIRE(is_read && again == bytes);
}

void observe_all(PlaybackBus& bus, std::uint64_t& seen) {
  for_each_topic([&]<typename Message>(const Topic<Message>& topic) {
    for (std::uint32_t robot = 0; robot < (topic.per_robot ? 3u : 1u); ++robot)
      bus.observe<Message>(topic, robot, [&bus, &seen, topic](const Message& message) {
        ++seen;
        SIDESTEP_REQUIRE(to_ns(bus.now()) >= 0 && to_ns(bus.now()) < kMaxTime_ns);
        check_message(topic, message);
      });
  });
}

/// Returns whether the file is a recording of Sidestep.
bool try_playback(const std::string& path) {
  try {
    PlaybackBus bus(path);
    std::uint64_t seen = 0;
    observe_all(bus, seen);
    bus.on_event([](Time at, const std::string&, const std::string&) { SIDESTEP_REQUIRE(to_ns(at) >= 0); });
    const PlaybackResult result = bus.play();
    SIDESTEP_REQUIRE(seen + result.unreadable <= result.messages);
    SIDESTEP_REQUIRE(bus.progress() >= 0 && bus.progress() <= 1);
    try {
      (void)bus.scenario();
    } catch (const ConfigError&) {
    }
    return result.messages > 0;
  } catch (const std::invalid_argument& error) {
    SIDESTEP_REQUIRE(std::string_view(error.what()).starts_with(path) ||
                     std::string_view(error.what()).starts_with("the recording contains no scenario"));
    return false;
  }
}

/// Counts the messages that the reader returns, in the simplest way.
void check_info(const std::string& path, std::size_t file_bytes) {
  const BagInfo info = bag_info(path);
  SIDESTEP_REQUIRE(info.file_bytes == file_bytes);
  std::uint64_t messages = 0;
  for (const auto& [topic, channel] : info.channels) {
    SIDESTEP_REQUIRE(channel.messages > 0);
    messages += channel.messages;
  }
  SIDESTEP_REQUIRE(messages == info.messages);
  SIDESTEP_REQUIRE(messages == 0 || info.first_ns <= info.last_ns);
  (void)to_text(info);
}

Bytes recording(bool is_compressed, std::uint64_t max_chunk_ns) {
  const TemporaryFolder folder;
  const std::string path = folder.file("run.mcap");
  RecordingHeader header{
      "two", "robots:\n  - {id: 0, start_m: [-2, 0]}\n  - {id: 1, start_m: [2, 1]}\n", {}, true};
  MapGrid grid;
  grid.columns = 4, grid.rows = 3;
  header.map = std::make_shared<const OccupancyMap>(grid, BitGrid(4, 3));
  McapWriterSettings settings;
  settings.is_compressed = is_compressed, settings.max_chunk_ns = max_chunk_ns;
  RecordingWriter writer(path, header, settings);
  std::int64_t at_ns = 1'000'000'000;
  for_each_topic([&]<typename Message>(const Topic<Message>& topic) {
    if (topic.qos == Qos::kImage) return;
    const std::uint16_t channel = writer.add_channel(topic, channel_name(topic, 1));
    const Message message;
    writer.add(time_from_ns(at_ns += 1'000'000), topic, channel, message.header(), &message);
  });
  writer.add_event(time_from_ns(at_ns), "bookmark", "here");
  writer.add_report(time_from_ns(at_ns), "{}");
  writer.close();
  return file_content(path);
}

/// Sets all checksums to 0, which means "no checksum", because random changes would never pass them. Finds
/// them at the positions of the writer's own records.
void remove_checksums(Bytes& file) {
  const auto number_at = [&](std::size_t at) {
    std::uint64_t value = 0;
    for (std::size_t i = 8; i-- > 0;) value = value << 8 | file[at + i];
    return value;
  };
  const auto clear = [&](std::size_t at) {
    std::fill_n(file.begin() + static_cast<std::ptrdiff_t>(at), 4, 0);
  };
  for (std::size_t at = kMcapMagic.size(); at + kMcapFrameSize < file.size();) {
    const auto kind = static_cast<McapRecordKind>(file[at]);
    const std::size_t content = at + kMcapFrameSize, size = number_at(at + 1);
    if (size > file.size() - content) break;
    if (kind == McapRecordKind::kDataEnd) clear(content);
    if (kind == McapRecordKind::kChunk) clear(content + 24);
    if (kind == McapRecordKind::kAttachment || kind == McapRecordKind::kFooter) clear(content + size - 4);
    at = content + size;
  }
}

}  // namespace

bool try_input(View input) {
  static const TemporaryFolder folder;
  const std::string path = folder.file("run.mcap");
  write_input(path, input);
  try {
    check_info(path, input.size());
  } catch (const std::invalid_argument& error) {
    SIDESTEP_REQUIRE(std::string_view(error.what()).starts_with(path));
    return false;  // not an MCAP file
  }
  return try_playback(path);
}

std::vector<Bytes> seeds() {
  std::vector<Bytes> result{recording(false, 1'000'000'000), recording(true, 1'000'000'000),
                            recording(true, 5'000'000)};
  for (std::size_t i = 0; i < 3; ++i) {
    result.push_back(result[i]);
    remove_checksums(result.back());
  }
  return result;
}

}  // namespace sidestep::fuzz
