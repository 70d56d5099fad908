// SPDX-License-Identifier: Apache-2.0
#include "vision/league/steady_sender_clock.hpp"

#include <algorithm>

namespace sidestep {

Duration SteadySenderClock::min_lag() const {
  return *std::min_element(min_lags_.begin(), min_lags_.begin() + static_cast<std::ptrdiff_t>(parts_));
}

void SteadySenderClock::reset(Duration lag, Time arrival) {
  min_lags_[0] = lag;
  parts_ = 1;
  part_since_ = arrival;
  disagreement_ = {};
}

void SteadySenderClock::update(Duration lag, Time arrival) {
  disagreement_ = {};
  if (arrival - part_since_ < kWindowPart) {
    min_lags_[0] = std::min(min_lags_[0], lag);
    return;
  }
  std::copy_backward(min_lags_.begin(), min_lags_.end() - 1, min_lags_.end());
  min_lags_[0] = lag;
  parts_ = std::min(parts_ + 1, kWindowParts);
  part_since_ = arrival;
}

bool SteadySenderClock::confirms_jump(Duration lag, Time arrival, bool is_forward) {
  const bool agrees = disagreement_.count > 0 && lag >= disagreement_.min_lag - kMaxAhead &&
                      lag <= disagreement_.min_lag + kMaxAhead;
  if (!agrees) disagreement_ = {lag, arrival, 0};
  disagreement_.min_lag = std::min(disagreement_.min_lag, lag);
  ++disagreement_.count;
  return disagreement_.count >= kMinAgreeing &&
         (is_forward || arrival - disagreement_.since >= kMinAgreementTime);
}

std::optional<DatedCapture> SteadySenderClock::add(Duration captured, Duration sent, Time arrival) {
  const Duration lag = arrival.time_since_epoch() - sent;
  if (parts_ == 0) {
    settled_at_ = arrival + kSettlingTime;
    reset(lag, arrival);
  } else if (lag < min_lag() - kMaxAhead || lag > min_lag() + kMaxDelay) {
    if (!confirms_jump(lag, arrival, lag < min_lag())) return std::nullopt;
    ++jumps_;
    reset(disagreement_.min_lag, arrival);
  } else {
    update(lag, arrival);
  }
  if (arrival < settled_at_) return std::nullopt;
  return DatedCapture{Time{captured + min_lag()}, kUncertainty + (lag - min_lag())};
}

}  // namespace sidestep
