// SPDX-License-Identifier: Apache-2.0
#include "deploy/monitor/record/recording.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <span>
#include <stdexcept>

#include "common/messaging/cdr.hpp"
#include "deploy/monitor/time_range.hpp"

namespace sidestep {
namespace {

constexpr char kMagic[] = "SIDEREC1";  // the last character is the format version
constexpr std::size_t kMagicSize = sizeof kMagic - 1;
constexpr std::size_t kMaxBlockSize = 4 << 20;
constexpr std::size_t kMaxChannels = 1 << 16;
enum BlockKind : std::uint8_t { kHeaderBlock = 1, kChannelBlock = 2, kMessageBlock = 3 };

/// CRC-32 as in ZIP and Ethernet.
std::uint32_t checksum(std::span<const std::uint8_t> bytes) {
  static const auto table = [] {
    std::array<std::uint32_t, 256> values{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      values[i] = i;
      for (int bit = 0; bit < 8; ++bit) values[i] = values[i] >> 1 ^ (values[i] & 1 ? 0xedb88320u : 0);
    }
    return values;
  }();
  std::uint32_t sum = ~0u;
  for (const std::uint8_t byte : bytes) sum = table[(sum ^ byte) & 0xff] ^ sum >> 8;
  return ~sum;
}

template <typename Number>
void put(std::vector<std::uint8_t>& bytes, Number number) {
  for (std::size_t i = 0; i < sizeof number; ++i)
    bytes.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(number) >> 8 * i));
}

void put(std::vector<std::uint8_t>& bytes, const std::string& text) {
  put(bytes, static_cast<std::uint32_t>(text.size()));
  bytes.insert(bytes.end(), text.begin(), text.end());
}

/// Reads numbers and strings from the front of a block. After the first read beyond its end, `ok` is false
/// and all results are zero or empty.
struct ByteReader {
  std::span<const std::uint8_t> left;
  bool ok = true;

  std::span<const std::uint8_t> bytes(std::size_t count) {
    ok = ok && count <= left.size();
    if (!ok) return {};
    const auto taken = left.first(count);
    left = left.subspan(count);
    return taken;
  }
  std::uint64_t number(std::size_t size) {
    std::uint64_t value = 0;
    std::size_t shift = 0;
    for (const std::uint8_t byte : bytes(size)) value |= std::uint64_t{byte} << 8 * shift++;
    return value;
  }
  std::string text() {
    const auto taken = bytes(static_cast<std::size_t>(number(4)));
    return {taken.begin(), taken.end()};
  }
};

/// Contains the type, so a subscriber never gets a message of another type, even from a corrupt file.
std::string reader_key(const TopicInfo& topic, const std::string& channel) {
  return std::string(topic.type.name) + ' ' + channel;
}

}  // namespace

RecordingHeader recording_header(const std::string& scenario_name, const std::string& scenario_file) {
  std::ifstream file(scenario_file);
  RecordingHeader header{scenario_name, {std::istreambuf_iterator<char>(file), {}}, false};
  if (!file) throw std::runtime_error(scenario_file + ": cannot be read");
  return header;
}

RecordingWriter::RecordingWriter(const std::string& path, const RecordingHeader& header)
    : path_(path), file_(std::fopen(path.c_str(), "wb")) {
  if (!file_) throw std::runtime_error(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
  has_failed_ = std::fwrite(kMagic, 1, kMagicSize, file_.get()) != kMagicSize;
  std::vector<std::uint8_t> block{kHeaderBlock};
  put(block, static_cast<std::uint8_t>(header.is_complete));
  put(block, header.scenario_name);
  put(block, header.scenario_text);
  if (block.size() > kMaxBlockSize)
    throw std::runtime_error(path + ": the scenario file is too large to be recorded");
  write_block(block);
}

void RecordingWriter::write_block(const std::vector<std::uint8_t>& block) {
  std::vector<std::uint8_t> frame;
  put(frame, static_cast<std::uint32_t>(block.size()));
  put(frame, checksum(block));
  has_failed_ = has_failed_ || std::fwrite(frame.data(), 1, frame.size(), file_.get()) != frame.size() ||
                std::fwrite(block.data(), 1, block.size(), file_.get()) != block.size();
}

void RecordingWriter::add(Time received, const TopicInfo& topic, const std::string& channel,
                          const void* message) {
  const auto [entry, is_new] = channels_.try_emplace(channel, static_cast<std::uint32_t>(channels_.size()));
  if (is_new) {
    std::vector<std::uint8_t> block{kChannelBlock};
    put(block, std::string(topic.name));
    put(block, channel);
    write_block(block);
  }
  block_.assign(1, kMessageBlock);
  put(block_, entry->second);
  put(block_, to_ns(received));
  append_cdr(topic, message, block_);
  write_block(block_);
  ++messages_;
}

void RecordingWriter::close() {
  has_failed_ = has_failed_ || std::fflush(file_.get()) != 0;
  if (has_failed_) throw std::runtime_error(path_ + ": some writes failed");
}

void record(Bus& bus, const Scenario& scenario, RecordingWriter& writer) {
  const auto subscribe = [&]<typename Message>(const Topic<Message>& topic) {
    std::vector<RobotId> robots{0};
    if (topic.per_robot) {
      robots.clear();
      for (const RobotSpec& spec : scenario.robots) robots.push_back(spec.id);
    }
    for (const RobotId robot : robots) {
      bus.observe<Message>(
          topic, robot, [&bus, &writer, topic, channel = channel_name(topic, robot)](const Message& message) {
            writer.add(bus.now(), topic, channel, &message);
          });
    }
  };
  subscribe(topics::kDetections);
  subscribe(topics::kWorld);
  subscribe(topics::kObstacles);
  subscribe(topics::kCommand);
  subscribe(topics::kFeedback);
  subscribe(topics::kScan);
  subscribe(topics::kRegistration);
  subscribe(topics::kProposal);
  subscribe(topics::kVerdict);
  subscribe(topics::kLedger);
  subscribe(topics::kCoordinator);
  subscribe(topics::kStatus);
  subscribe(topics::kAttestation);
  subscribe(topics::kOrder);
  subscribe(topics::kOrderAnswer);
  subscribe(topics::kOrderMemory);
  subscribe(topics::kOrderStatus);
  subscribe(topics::kDisturbance);
  subscribe(topics::kNetworkFault);
  subscribe(topics::kTruth);
  subscribe(topics::kRules);
  subscribe(topics::kCounters);
  subscribe(topics::kClockProbe);
  subscribe(topics::kClockReading);
}

PlaybackBus::PlaybackBus(const std::string& path) : file_(std::fopen(path.c_str(), "rb")) {
  if (!file_) throw std::runtime_error(fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
  char magic[kMagicSize];
  const bool has_magic = std::fread(magic, 1, kMagicSize, file_.get()) == kMagicSize &&
                         std::memcmp(magic, kMagic, kMagicSize) == 0;
  if (!has_magic) throw std::runtime_error(path + ": is not a recording, or one of another format version");
  std::string damage;
  ByteReader reader{{}};
  if (read_block(damage)) reader.left = block_;
  if (reader.number(1) != kHeaderBlock) damage = "the header is missing";
  header_.is_complete = reader.number(1) == 1;
  header_.scenario_name = reader.text();
  header_.scenario_text = reader.text();
  if (!damage.empty() || !reader.ok)
    throw std::runtime_error(fmt::format("{}: {}", path, damage.empty() ? "the header is damaged" : damage));
}

bool PlaybackBus::read_block(std::string& damage) {
  std::array<std::uint8_t, 8> frame{};
  const std::size_t got = std::fread(frame.data(), 1, frame.size(), file_.get());
  if (got == 0) return false;
  ByteReader reader{frame};
  const auto size = static_cast<std::size_t>(reader.number(4));
  const auto sum = static_cast<std::uint32_t>(reader.number(4));
  if (got == frame.size() && size > kMaxBlockSize) {
    damage = fmt::format("a block claims a size of {} bytes", size);
    return false;
  }
  block_.resize(got == frame.size() ? size : 0);
  if (got < frame.size() || std::fread(block_.data(), 1, size, file_.get()) != size) {
    damage = "the file ends in the middle of a block";
  } else if (checksum(block_) != sum) {
    damage = "a block has a wrong checksum";
  }
  return damage.empty();
}

bool PlaybackBus::deliver_block(PlaybackResult& result) {
  ByteReader reader{block_};
  const auto kind = reader.number(1);
  if (kind == kChannelBlock) {
    const std::string topic = reader.text(), name = reader.text();
    for (const TopicInfo& known : all_topics()) {
      if (reader.ok && topic == known.name && channels_.size() < kMaxChannels) {
        channels_.push_back({known, name});
        return true;
      }
    }
    result.damage = "a channel belongs to an unknown topic";
    return false;
  }
  const auto id = static_cast<std::size_t>(reader.number(4));
  const auto received_ns = static_cast<std::int64_t>(reader.number(8));
  if (kind != kMessageBlock || !reader.ok || id >= channels_.size() || !is_valid_time(received_ns)) {
    result.damage = "a block has an unknown kind, channel or time";
    return false;
  }
  now_ = time_from_ns(received_ns);
  ++result.messages;
  const auto readers = readers_.find(reader_key(channels_[id].topic, channels_[id].name));
  const bool was_read = read_cdr(channels_[id].topic, reader.left, [&](const void* message) {
    if (readers == readers_.end()) return;
    for (const auto& callback : readers->second) callback(message);
  });
  if (!was_read) ++result.unreadable;
  return true;
}

PlaybackResult PlaybackBus::play() {
  PlaybackResult result;
  while (read_block(result.damage) && deliver_block(result)) {
  }
  return result;
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
