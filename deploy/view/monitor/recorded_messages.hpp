// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/time/time.hpp"
#include "deploy/inspect/record/playback_bus.hpp"

namespace sidestep {

/// Finds the messages of one channel of a recording in any interval, for the inspector.
class RecordedMessages {
 public:
  /// `playback` reads the same file; only the part that it has already read is searched. It must outlive this
  /// object.
  RecordedMessages(const std::string& path, const PlaybackBus& playback)
      : reader_(path), playback_(playback) {}

  static constexpr std::size_t kMaxBytes = 2 << 20;

  /// The messages received after `from` and up to `to`, as {"at_s":…, "message":…}. If they exceed kMaxBytes,
  /// only the last ones. Empty if no topic has the channel.
  [[nodiscard]] std::vector<std::string> between(const std::string& channel, Time from, Time to);

 private:
  McapReader reader_;
  const PlaybackBus& playback_;
};

}  // namespace sidestep
