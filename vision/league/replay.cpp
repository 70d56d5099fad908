// SPDX-License-Identifier: Apache-2.0
#include "vision/league/replay.hpp"

#include <algorithm>

namespace sidestep {

Time Replay::due(Time received) const {
  // Limits delays to ten years, because a log's times range from 1970 to 2043 and the speed is arbitrary.
  constexpr double kMaxElapsed_s = 3e8;
  const double elapsed_s = to_seconds(received - *first_received_) / speed_;
  return began_at_ + from_seconds(std::clamp(elapsed_s, 0.0, kMaxElapsed_s));
}

std::optional<Time> Replay::advance(Time now, const Send& send) {
  if (!first_received_) {
    if (!reader_.next(next_)) return std::nullopt;
    began_at_ = now;
    first_received_ = next_.received;
  }
  constexpr int kMaxBatch = 64;
  for (int i = 0; i < kMaxBatch && due(next_.received) <= now; ++i) {
    send(next_);
    if (!reader_.next(next_)) return std::nullopt;
  }
  return due(next_.received);
}

}  // namespace sidestep
