// SPDX-License-Identifier: Apache-2.0
#include "vision/league/scaled_sender_clock.hpp"

#include <algorithm>

namespace sidestep {
namespace {

/// Messages up to this much later than predicted are on time: arrivals jitter.
constexpr Duration kJitter{4'000'000};
/// Times of the sender that are further apart belong to different runs of its clock.
constexpr Duration kMaxStep{2'000'000'000};

}  // namespace

void ScaledSenderClock::keep(const Message& message) {
  messages_[next_] = message;
  next_ = (next_ + 1) % messages_.size();
  count_ = std::min(count_ + 1, messages_.size());
}

std::optional<Time> ScaledSenderClock::predicted_arrival(const Message& message, double rate) const {
  Time earliest = Time::max();
  for (std::size_t i = 1; i <= count_; ++i) {
    const Message& other = messages_[(next_ + messages_.size() - i) % messages_.size()];
    if (message.arrival - other.arrival > kWindow) continue;
    const Duration step = message.sent - other.sent;
    if (std::chrono::abs(step) > kMaxStep) return std::nullopt;
    earliest = std::min(earliest, other.arrival + from_seconds(to_seconds(step) / rate));
  }
  return earliest == Time::max() ? message.arrival : earliest;
}

bool ScaledSenderClock::confirms_jump(const Message& message) {
  const bool agrees = contradictions_ > 0 && message.sent >= contradicting_.sent &&
                      message.sent - contradicting_.sent <= kMaxDelay;
  contradictions_ = agrees ? contradictions_ + 1 : 1;
  contradicting_ = message;
  if (contradictions_ < kMinAgreeing) return false;
  ++jumps_;
  contradictions_ = 0;
  return true;
}

std::optional<DatedCapture> ScaledSenderClock::add(Duration captured, Duration sent, Time arrival,
                                                   double rate) {
  const Message message{sent, arrival};
  if (count_ == 0 || arrival - last_arrival_ > kMaxSilence) {
    count_ = 0;
    contradictions_ = 0;
    settled_at_ = arrival + kSettlingTime;
  }
  last_arrival_ = arrival;
  const auto predicted = predicted_arrival(message, rate);
  if (!predicted || arrival - *predicted > kMaxDelay || *predicted - arrival > kMaxAhead) {
    if (!confirms_jump(message)) return std::nullopt;
    count_ = 0;
    settled_at_ = arrival + kSettlingTime;
  } else {
    contradictions_ = 0;
  }
  keep(message);
  if (arrival < settled_at_) return std::nullopt;
  const Duration late = arrival - std::min(*predicted, arrival);
  const Duration correction = std::max(Duration{0}, late - kJitter) / 2;
  const Duration processing = std::min(from_seconds(to_seconds(sent - captured) / rate), kMaxDelay);
  return DatedCapture{arrival - late + correction - processing,
                      kUncertainty + std::max(correction, late - correction)};
}

}  // namespace sidestep
