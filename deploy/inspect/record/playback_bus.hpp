// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/messaging/bus.hpp"
#include "deploy/inspect/record/mcap/mcap_reader.hpp"
#include "deploy/inspect/record/recording.hpp"

namespace sidestep {

/// The result of playing a recording.
struct PlaybackResult {
  std::uint64_t messages = 0;
  std::uint64_t unreadable = 0;  ///< number of messages that could not be decoded as their topic's type
  std::string damage;            ///< why playback stopped before the end of the file; empty: it did not
};

/// A bus that plays back a recording: subscribe first, then play. Arbitrary file contents are handled safely;
/// the worst outcome is that playback ends early. Channels with other programs' topics are skipped.
class PlaybackBus : public Bus {
 public:
  /// Throws std::runtime_error when the file cannot be read or is not a recording of Sidestep.
  explicit PlaybackBus(const std::string& path);

  const RecordingHeader& header() const { return header_; }
  /// The recorded scenario with its map. Throws ConfigError.
  [[nodiscard]] Scenario scenario() const;
  /// The reception time of the current message.
  Time now() const override { return now_; }
  /// Timers never fire during playback.
  void at(Time, std::function<void()>) override {}
  /// Delivers all messages in the file's order, until stop() is called.
  [[nodiscard]] PlaybackResult play();
  /// Delivers the next message. False if there is none, or stop() was called.
  [[nodiscard]] bool play_next(PlaybackResult& result);
  /// A part of the file that has been read, and the time of its first message.
  struct ChunkPosition {
    Time first_at{};
    std::uint64_t offset = 0;
  };
  /// The chunks in the order of the file.
  const std::vector<ChunkPosition>& chunks() const { return chunks_; }
  const McapReader& reader() const { return reader_; }
  /// The fraction of the file that has been read, 0 to 1.
  double progress() const { return reader_.progress(); }
  /// Calls back for each event of the recording (RecordingWriter::add_event).
  void on_event(std::function<void(Time, const std::string& kind, const std::string& text)> callback) {
    on_event_ = std::move(callback);
  }
  /// Stops the delivery of messages. May be called from callbacks and signal handlers.
  void stop() {
    is_stopped_ = true;
    reader_.stop();
  }

 protected:
  /// Returns a writer that discards everything.
  std::unique_ptr<RawWriter> make_writer(const TopicInfo& topic, const std::string& channel) override;
  void make_reader(const TopicInfo& topic, const std::string& channel,
                   std::function<void(const void*)> callback) override;

 private:
  /// Reads the file up to its first message.
  void read_header(const std::string& path);
  void deliver_event(const McapMetadata& metadata);
  /// Passes a message to its subscribers. False if the message is damaged.
  bool deliver(const McapMessage& message, PlaybackResult& result);
  /// The row of the topic table to which a channel belongs; nullptr if none.
  const TopicInfo* topic_of(const McapMessage& message);

  McapReader reader_;
  McapRecord next_;
  std::vector<ChunkPosition> chunks_;
  std::vector<McapMetadata> early_events_;  ///< events before the first message
  RecordingHeader header_;
  Time now_{};
  std::atomic<bool> is_stopped_ = false;
  std::vector<TopicInfo> topics_ = all_topics();
  std::map<std::uint16_t, const TopicInfo*> topic_of_channel_;
  std::map<std::string, std::vector<std::function<void(const void*)>>> readers_;
  std::function<void(Time, const std::string&, const std::string&)> on_event_;
};

}  // namespace sidestep
