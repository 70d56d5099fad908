// SPDX-License-Identifier: Apache-2.0
#include "vision/league/sender_rate.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

constexpr double kMinDeviation = 0.004;
constexpr Duration kMaxSteadyShift{3'000'000};
/// After a longer silence, earlier messages say nothing about the present rate.
constexpr Duration kMaxSilence{500'000'000};

}  // namespace

void SenderRate::reset() {
  next_ = count_ = 0;
  open_.reset();
}

void SenderRate::add(Duration sent, Time arrival) {
  const Message message{sent, arrival};
  if (open_ && arrival - open_since_ >= kPart + kMaxSilence) reset();
  if (open_ && arrival - open_since_ >= kPart) {
    parts_[next_] = *open_;
    next_ = (next_ + 1) % kParts;
    count_ = std::min(count_ + 1, kParts);
    open_.reset();
  }
  if (!open_) {
    open_since_ = arrival;
    open_ = message;
  } else if (message.lag() < open_->lag()) {
    open_ = message;
  }
}

const SenderRate::Message& SenderRate::fastest(std::size_t age) const {
  const Message* best = &part(age);
  for (std::size_t i = 1; i < kPartsOfEnd; ++i)
    if (part(age + i).lag() < best->lag()) best = &part(age + i);
  return *best;
}

std::optional<double> SenderRate::rate() const {
  if (count_ < 2 * kPartsOfEnd) return std::nullopt;
  const std::size_t parts = std::min(count_, kPartsOfRate);
  const Message &newer = fastest(0), &older = fastest(parts - kPartsOfEnd);
  const double local_s = to_seconds(newer.arrival - older.arrival);
  const double rate = to_seconds(newer.sent - older.sent) / local_s;
  if (!(local_s > 0 && rate >= kMinRate && rate <= kMaxRate)) return std::nullopt;
  return std::abs(rate - 1) < kMinDeviation ? 1 : rate;
}

std::optional<Duration> SenderRate::fallen_behind() const {
  if (count_ < 2 * kPartsOfEnd) return std::nullopt;
  return fastest(0).lag() - fastest(count_ - kPartsOfEnd).lag();
}

bool SenderRate::is_steady() const {
  return count_ == kParts && std::chrono::abs(*fallen_behind()) <= kMaxSteadyShift;
}

}  // namespace sidestep
