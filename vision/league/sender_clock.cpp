// SPDX-License-Identifier: Apache-2.0
#include "vision/league/sender_clock.hpp"

#include <algorithm>

namespace sidestep {

Duration SenderClock::least() const {
  return *std::min_element(least_.begin(), least_.begin() + static_cast<std::ptrdiff_t>(parts_));
}

void SenderClock::begin(Duration lag, Time arrival) {
  least_[0] = lag;
  parts_ = 1;
  part_since_ = arrival;
  doubt_ = {};
}

void SenderClock::note(Duration lag, Time arrival) {
  doubt_ = {};
  if (arrival - part_since_ < kPart) {
    least_[0] = std::min(least_[0], lag);
    return;
  }
  std::copy_backward(least_.begin(), least_.end() - 1, least_.end());
  least_[0] = lag;
  parts_ = std::min(parts_ + 1, kParts);
  part_since_ = arrival;
}

bool SenderClock::is_jump(Duration lag, Time arrival, bool is_ahead) {
  const bool agrees =
      doubt_.count > 0 && lag >= doubt_.least - kMostAhead && lag <= doubt_.least + kMostAhead;
  if (!agrees) doubt_ = {lag, arrival, 0};
  doubt_.least = std::min(doubt_.least, lag);
  ++doubt_.count;
  return doubt_.count >= kAgreeing && (is_ahead || arrival - doubt_.since >= kAgreeingFor);
}

std::optional<Time> SenderClock::add(Duration captured, Duration sent, Time arrival) {
  if (sent < captured || sent - captured > kMostDelay) sent = captured;
  const Duration lag = arrival.time_since_epoch() - sent;
  if (parts_ == 0) {
    settled_at_ = arrival + kSettling;
    begin(lag, arrival);
  } else if (lag < least() - kMostAhead || lag > least() + kMostDelay) {
    if (!is_jump(lag, arrival, lag < least())) return std::nullopt;
    ++jumps_;
    begin(doubt_.least, arrival);
  } else {
    note(lag, arrival);
  }
  return arrival >= settled_at_ ? std::optional(Time{captured + least()}) : std::nullopt;
}

}  // namespace sidestep
