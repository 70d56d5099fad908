// SPDX-License-Identifier: Apache-2.0
#include "vision/league/replay.hpp"

#include <algorithm>

namespace sidestep {

Time Replay::due(Time received) const {
  // A log's times may be anything between 1970 and 2043, and the speed too; a pause of ten years is one of
  // any length.
  constexpr double kLongest_s = 3e8;
  const double passed_s = to_seconds(received - *first_received_) / speed_;
  return began_at_ + from_seconds(std::clamp(passed_s, 0.0, kLongest_s));
}

std::optional<Time> Replay::advance(Time now, const Send& send) {
  if (!first_received_) {
    if (!reader_.next(next_)) return std::nullopt;
    began_at_ = now;
    first_received_ = next_.received;
  }
  constexpr int kMostAtOnce = 64;
  for (int i = 0; i < kMostAtOnce && due(next_.received) <= now; ++i) {
    send(next_);
    if (!reader_.next(next_)) return std::nullopt;
  }
  return due(next_.received);
}

}  // namespace sidestep
