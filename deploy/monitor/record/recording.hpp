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

/// What a recording says of itself.
struct RecordingHead {
  std::string scenario;      ///< its name
  std::string text;          ///< the scenario file
  bool is_complete = false;  ///< every message from the start on, each at the moment when it was sent
};

/// Of a recording that is not complete. Throws std::runtime_error when the scenario file cannot be read.
RecordingHead recording_head(const std::string& scenario, const std::string& scenario_file);

/// Writes messages with the time they were heard at into a file. After the magic number come blocks, each
/// with its length and a check sum, so that a file that ends anywhere is good up to there. All numbers are
/// little-endian.
class RecordingWriter {
 public:
  /// Throws std::runtime_error, saying why the file cannot be written.
  RecordingWriter(const std::string& path, const RecordingHead& head);

  void add(Time heard, const TopicInfo& topic, const std::string& channel, const void* message);
  std::uint64_t messages() const { return messages_; }
  /// Writes out what is still in memory; throws std::runtime_error when not all of it could be written.
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

/// Subscribes to every topic but images, which are a hundred megabytes a second, with every robot's channels,
/// and writes what comes until the bus has stopped.
void record(Bus& bus, const Scenario& scenario, RecordingWriter& writer);

/// What came of reading a recording.
struct RecordingEnd {
  std::uint64_t messages = 0;
  std::uint64_t unreadable = 0;  ///< messages whose bytes were not of their topic's type
  std::string damage;            ///< why reading ended before the file's end; empty: it did not
};

/// A bus on which a recording is heard again: subscribe, then play. Whatever is in the file, nothing worse
/// happens than that the reading ends.
class PlaybackBus : public Bus {
 public:
  /// Throws std::runtime_error when the file cannot be read or is no recording.
  explicit PlaybackBus(const std::string& path);

  const RecordingHead& head() const { return head_; }
  /// The time at which the message that is being heard was heard.
  Time now() const override { return now_; }
  /// There are no timers in the past: never calls back.
  void at(Time, std::function<void()>) override {}
  /// All messages in the file's order.
  RecordingEnd play();

 protected:
  /// What is written is not heard by anybody.
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
  /// False at the file's end, or with `damage` set.
  bool read_block(std::string& damage);
  bool hear_block(RecordingEnd& end);

  std::unique_ptr<std::FILE, Closer> file_;
  RecordingHead head_;
  Time now_{};
  std::vector<std::uint8_t> block_;
  std::vector<Channel> channels_;
  std::map<std::string, std::vector<std::function<void(const void*)>>> readers_;
};

}  // namespace sidestep
