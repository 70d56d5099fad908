// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "common/league/log_file.hpp"

namespace sidestep {

/// Gives a log's records back in the rhythm in which they were received, so many times as fast.
class Replay {
 public:
  using Send = std::function<void(const league::LogRecord&)>;

  /// Precondition: speed > 0. The reader stays the caller's.
  Replay(league::LogReader& reader, double speed) : reader_(reader), speed_(speed) {}

  /// Sends what is due, and says when the next record will be; nothing at the log's end. The first call is
  /// the beginning. Records that were received before the one ahead of them are due with it.
  std::optional<Time> advance(Time now, const Send& send);

 private:
  Time due(Time received) const;

  league::LogReader& reader_;
  double speed_;
  Time began_at_{};
  std::optional<Time> first_received_;
  league::LogRecord next_;
};

}  // namespace sidestep
