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

namespace sidestep {
namespace {

constexpr char kMagic[] = "SIDEREC1";  // the last is the version of the format
constexpr std::size_t kMagicSize = sizeof kMagic - 1;
constexpr std::size_t kLongestBlock = 4 << 20;
constexpr std::size_t kMostChannels = 1 << 16;
enum BlockKind : std::uint8_t { kHeadBlock = 1, kChannelBlock = 2, kMessageBlock = 3 };

/// CRC-32 as in zip and Ethernet.
std::uint32_t check_sum(std::span<const std::uint8_t> bytes) {
  static const auto table = [] {
    std::array<std::uint32_t, 256> made{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      made[i] = i;
      for (int bit = 0; bit < 8; ++bit) made[i] = made[i] >> 1 ^ (made[i] & 1 ? 0xedb88320u : 0);
    }
    return made;
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

/// Takes numbers and texts from a block's front; once something does not fit, everything is empty and `ok`
/// false.
struct Taker {
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

/// So that nobody gets a message of another type than they subscribed to, whatever a file calls its channels.
std::string reader_key(const TopicInfo& topic, const std::string& channel) {
  return std::string(topic.type.name) + ' ' + channel;
}

}  // namespace

RecordingHead recording_head(const std::string& scenario, const std::string& scenario_file) {
  std::ifstream file(scenario_file);
  RecordingHead head{scenario, {std::istreambuf_iterator<char>(file), {}}, false};
  if (!file) throw std::runtime_error(scenario_file + ": cannot be read");
  return head;
}

RecordingWriter::RecordingWriter(const std::string& path, const RecordingHead& head)
    : path_(path), file_(std::fopen(path.c_str(), "wb")) {
  if (!file_) throw std::runtime_error(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
  has_failed_ = std::fwrite(kMagic, 1, kMagicSize, file_.get()) != kMagicSize;
  std::vector<std::uint8_t> block{kHeadBlock};
  put(block, static_cast<std::uint8_t>(head.is_complete));
  put(block, head.scenario);
  put(block, head.text);
  if (block.size() > kLongestBlock)
    throw std::runtime_error(path + ": the scenario is too long to be recorded");
  write_block(block);
}

void RecordingWriter::write_block(const std::vector<std::uint8_t>& block) {
  std::vector<std::uint8_t> frame;
  put(frame, static_cast<std::uint32_t>(block.size()));
  put(frame, check_sum(block));
  has_failed_ = has_failed_ || std::fwrite(frame.data(), 1, frame.size(), file_.get()) != frame.size() ||
                std::fwrite(block.data(), 1, block.size(), file_.get()) != block.size();
}

void RecordingWriter::add(Time heard, const TopicInfo& topic, const std::string& channel,
                          const void* message) {
  const auto [at, is_new] = channels_.try_emplace(channel, static_cast<std::uint32_t>(channels_.size()));
  if (is_new) {
    std::vector<std::uint8_t> block{kChannelBlock};
    put(block, std::string(topic.name));
    put(block, channel);
    write_block(block);
  }
  block_.assign(1, kMessageBlock);
  put(block_, at->second);
  put(block_, to_ns(heard));
  append_cdr(topic, message, block_);
  write_block(block_);
  ++messages_;
}

void RecordingWriter::close() {
  has_failed_ = has_failed_ || std::fflush(file_.get()) != 0;
  if (has_failed_) throw std::runtime_error(path_ + ": not everything could be written");
}

void record(Bus& bus, const Scenario& scenario, RecordingWriter& writer) {
  const auto listen = [&]<typename Message>(const Topic<Message>& topic) {
    std::vector<RobotId> robots{0};
    if (topic.per_robot) {
      robots.clear();
      for (const RobotSpec& spec : scenario.robots) robots.push_back(spec.id);
    }
    for (const RobotId robot : robots) {
      bus.subscribe<Message>(
          topic, robot, [&bus, &writer, topic, channel = channel_name(topic, robot)](const Message& message) {
            writer.add(bus.now(), topic, channel, &message);
          });
    }
  };
  listen(topics::kDetections);
  listen(topics::kWorld);
  listen(topics::kCommand);
  listen(topics::kFeedback);
  listen(topics::kRegistration);
  listen(topics::kProposal);
  listen(topics::kVerdict);
  listen(topics::kLedger);
  listen(topics::kCoordinator);
  listen(topics::kStatus);
  listen(topics::kDisturbance);
  listen(topics::kNetworkFault);
  listen(topics::kTruth);
}

PlaybackBus::PlaybackBus(const std::string& path) : file_(std::fopen(path.c_str(), "rb")) {
  if (!file_) throw std::runtime_error(fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
  char magic[kMagicSize];
  const bool has_magic = std::fread(magic, 1, kMagicSize, file_.get()) == kMagicSize &&
                         std::memcmp(magic, kMagic, kMagicSize) == 0;
  if (!has_magic) throw std::runtime_error(path + ": is no recording (or one of another version)");
  std::string damage;
  Taker taker{{}};
  if (read_block(damage)) taker.left = block_;
  if (taker.number(1) != kHeadBlock) damage = "its head is missing";
  head_.is_complete = taker.number(1) == 1;
  head_.scenario = taker.text();
  head_.text = taker.text();
  if (!damage.empty() || !taker.ok)
    throw std::runtime_error(fmt::format("{}: {}", path, damage.empty() ? "its head is damaged" : damage));
}

bool PlaybackBus::read_block(std::string& damage) {
  std::array<std::uint8_t, 8> frame;
  const std::size_t got = std::fread(frame.data(), 1, frame.size(), file_.get());
  if (got == 0) return false;
  Taker taker{frame};
  const auto size = static_cast<std::size_t>(taker.number(4));
  const auto sum = static_cast<std::uint32_t>(taker.number(4));
  if (got == frame.size() && size > kLongestBlock) {
    damage = fmt::format("a block claims to be {} bytes long", size);
    return false;
  }
  block_.resize(got == frame.size() ? size : 0);
  if (got < frame.size() || std::fread(block_.data(), 1, size, file_.get()) != size) {
    damage = "it ends in the middle of a block";
  } else if (check_sum(block_) != sum) {
    damage = "a block's check sum is wrong";
  }
  return damage.empty();
}

bool PlaybackBus::hear_block(RecordingEnd& end) {
  Taker taker{block_};
  const auto kind = taker.number(1);
  if (kind == kChannelBlock) {
    const std::string topic = taker.text(), name = taker.text();
    for (const TopicInfo& known : all_topics()) {
      if (taker.ok && topic == known.name && channels_.size() < kMostChannels) {
        channels_.push_back({known, name});
        return true;
      }
    }
    end.damage = "a channel is of an unknown topic";
    return false;
  }
  const auto id = static_cast<std::size_t>(taker.number(4));
  const auto heard_ns = static_cast<std::int64_t>(taker.number(8));
  const bool is_time = heard_ns >= 0 && heard_ns < std::int64_t{1} << 62;
  if (kind != kMessageBlock || !taker.ok || id >= channels_.size() || !is_time) {
    end.damage = "a block is of an unknown kind, channel or time";
    return false;
  }
  now_ = time_from_ns(heard_ns);
  ++end.messages;
  const auto readers = readers_.find(reader_key(channels_[id].topic, channels_[id].name));
  const bool was_read = read_cdr(channels_[id].topic, taker.left, [&](const void* message) {
    if (readers == readers_.end()) return;
    for (const auto& callback : readers->second) callback(message);
  });
  if (!was_read) ++end.unreadable;
  return true;
}

RecordingEnd PlaybackBus::play() {
  RecordingEnd end;
  while (read_block(end.damage) && hear_block(end)) {
  }
  return end;
}

std::unique_ptr<RawWriter> PlaybackBus::make_writer(const TopicInfo&, const std::string&) {
  struct Nowhere : RawWriter {
    void write(const void*) override {}
  };
  return std::make_unique<Nowhere>();
}

void PlaybackBus::make_reader(const TopicInfo& topic, const std::string& channel,
                              std::function<void(const void*)> callback) {
  readers_[reader_key(topic, channel)].push_back(std::move(callback));
}

}  // namespace sidestep
