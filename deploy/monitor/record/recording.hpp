// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/messaging/bus.hpp"

namespace sidestep {

/// The first block of a recording.
struct RecordingHeader {
  std::string scenario_name;
  std::string scenario_text;  ///< the scenario file
  bool is_complete = false;   ///< holds every message from the start on, with its time of sending
};

/// Header of an incomplete recording. Throws std::runtime_error when the scenario file cannot be read.
[[nodiscard]] RecordingHeader recording_header(const std::string& scenario_name,
                                               const std::string& scenario_file);

/// Writes messages with their time of reception to a file. The file is a magic number and a sequence of
/// blocks, each with its length and a checksum, so a truncated file is readable up to its last whole block.
/// All numbers are little-endian.
class RecordingWriter {
 public:
  /// Throws std::runtime_error with the reason when the file cannot be written.
  RecordingWriter(const std::string& path, const RecordingHeader& header);

  void add(Time received, const TopicInfo& topic, const std::string& channel, const void* message);
  std::uint64_t messages() const { return messages_; }
  /// Flushes the file; throws std::runtime_error when any write has failed.
  void close();

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void write_block(const std::vector<std::uint8_t>& block);

  std::string path_;
  std::unique_ptr<std::FILE, Closer> file_;
  std::map<std::string, std::uint32_t> channels_;
  std::vector<std::uint8_t> block_;
  std::uint64_t messages_ = 0;
  bool has_failed_ = false;
};

/// Subscribes to all channels of all topics except camera images (about 100 MB/s), and records their messages
/// until the bus stops.
void record(Bus& bus, const Scenario& scenario, RecordingWriter& writer);

/// The result of playing a recording.
struct PlaybackResult {
  std::uint64_t messages = 0;
  std::uint64_t unreadable = 0;  ///< messages that could not be decoded as their topic's type
  std::string damage;            ///< why playback stopped before the end of the file; empty: it did not
};

/// A bus that plays a recording: subscribe, then play. Arbitrary file contents are handled safely; the worst
/// outcome is that playback ends early.
class PlaybackBus : public Bus {
 public:
  /// Throws std::runtime_error when the file cannot be read or is not a recording.
  explicit PlaybackBus(const std::string& path);

  const RecordingHeader& header() const { return header_; }
  /// The time of reception of the current message.
  Time now() const override { return now_; }
  /// Timers never fire during playback.
  void at(Time, std::function<void()>) override {}
  /// Delivers all messages in the file's order.
  [[nodiscard]] PlaybackResult play();

 protected:
  /// Discards everything that is written.
  std::unique_ptr<RawWriter> make_writer(const TopicInfo& topic, const std::string& channel) override;
  void make_reader(const TopicInfo& topic, const std::string& channel,
                   std::function<void(const void*)> callback) override;

 private:
  struct Channel {
    TopicInfo topic;
    std::string name;
  };
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  /// False at the end of the file, or on damage, which is then described in `damage`.
  bool read_block(std::string& damage);
  bool deliver_block(PlaybackResult& result);

  std::unique_ptr<std::FILE, Closer> file_;
  RecordingHeader header_;
  Time now_{};
  std::vector<std::uint8_t> block_;
  std::vector<Channel> channels_;
  std::map<std::string, std::vector<std::function<void(const void*)>>> readers_;
};

}  // namespace sidestep
