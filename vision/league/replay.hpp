// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "common/league/log_file.hpp"

namespace sidestep {

/// Replays a log's records with their original timing, scaled by a speed factor.
class Replay {
 public:
  using Send = std::function<void(const league::LogRecord&)>;

  /// Precondition: speed > 0, and the reader outlives this object.
  Replay(league::LogReader& reader, double speed) : reader_(reader), speed_(speed) {}

  /// Sends the records that are due. Returns when the next one is due; nullopt at the end of the log. The
  /// first call starts the replay. A record that was received before its predecessor in the log is due
  /// together with it.
  [[nodiscard]] std::optional<Time> advance(Time now, const Send& send);

 private:
  Time due(Time received) const;

  league::LogReader& reader_;
  double speed_;
  Time began_at_{};
  std::optional<Time> first_received_;
  league::LogRecord next_;
};

}  // namespace sidestep
