// SPDX-License-Identifier: Apache-2.0
#include "vision/league/sender_clock.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace sidestep {
namespace {

/// A clock that gains or loses more than this within two seconds does not have the local clock's rate. With a
/// larger value, dates of a clock that is slower by half a percent would be too uncertain to be used.
constexpr Duration kMaxSteadyChange{4'000'000};
/// Uncertainty of a date until the rate has been measured.
constexpr Duration kUnprovenUncertainty{10'000'000};
constexpr Duration kMinSteadyTime{10'000'000'000};
/// Dates are arrivals after this time without a usable date, until dates are usable again for the other time.
constexpr Duration kMaxUselessTime{2'000'000'000}, kMinUsefulTime{5'000'000'000};
constexpr Duration kMaxUselessGap{500'000'000};
/// A silence counts as this much time, because a suspended process receives nothing.
constexpr Duration kMaxCountedGap{50'000'000};

}  // namespace

std::optional<DatedCapture> SenderClock::add(Duration captured, Duration sent, Time arrival) {
  if (sent < captured || sent - captured > SteadySenderClock::kMaxDelay) sent = captured;
  const auto dated = dated_by_sender(captured, sent, arrival);
  judge(dated, arrival);
  if (!is_by_arrival_) return dated;
  if (arrival < settled_at_) return std::nullopt;
  return DatedCapture{arrival, kArrivalUncertainty};
}

std::optional<DatedCapture> SenderClock::dated_by_sender(Duration captured, Duration sent, Time arrival) {
  const auto steadily = dated_steadily(captured, sent, arrival);
  if (kind_ == SenderClockKind::kSteady) {
    if (!steady_.is_consistent()) return std::nullopt;
    (void)dated_at_rate(captured, sent, arrival);
  }
  const auto at_rate = kind_ == SenderClockKind::kScaled ? dated_at_rate(captured, sent, arrival) : steadily;
  choose_rate(arrival);
  return at_rate;
}

std::optional<DatedCapture> SenderClock::dated_steadily(Duration captured, Duration sent, Time arrival) {
  const std::uint64_t jumps = steady_.jumps();
  auto dated = steady_.add(captured, sent, arrival);
  if (kind_ != SenderClockKind::kSteady) return dated;
  if (steady_.jumps() > jumps) {
    ++jumps_;
    measured_.reset();
    scaled_.reset();
  }
  if (steady_.is_consistent()) measured_.add(sent, arrival);
  // Whether the clock has the local clock's rate is known only after a while, and only to some accuracy.
  if (dated) dated->uncertainty += std::chrono::abs(measured_.fallen_behind().value_or(kUnprovenUncertainty));
  return dated;
}

std::optional<DatedCapture> SenderClock::dated_at_rate(Duration captured, Duration sent, Time arrival) {
  const std::uint64_t jumps = scaled_.jumps();
  auto dated = scaled_.add(captured, sent, arrival, rate_);
  if (kind_ != SenderClockKind::kScaled) return dated;
  if (scaled_.jumps() > jumps) {
    ++jumps_;
    measured_.reset();
  }
  if (scaled_.is_consistent()) measured_.add(sent, arrival);
  if (dated && !is_rate_known_) dated->uncertainty = std::max(dated->uncertainty, kArrivalUncertainty);
  return dated;
}

void SenderClock::choose_rate(Time arrival) {
  if (kind_ == SenderClockKind::kSteady) {
    const auto behind = measured_.fallen_behind();
    if (!behind || std::chrono::abs(*behind) <= kMaxSteadyChange) return;
    kind_ = SenderClockKind::kScaled;
    steady_since_.reset();
  }
  const auto rate = measured_.rate();
  is_rate_known_ = rate.has_value();
  if (rate) rate_ = *rate;
  if (!measured_.is_steady()) {
    steady_since_.reset();
  } else if (!steady_since_) {
    steady_since_ = arrival;
  } else if (arrival - *steady_since_ >= kMinSteadyTime) {
    kind_ = SenderClockKind::kSteady;
    rate_ = 1;
    is_rate_known_ = true;
  }
}

void SenderClock::judge(const std::optional<DatedCapture>& dated, Time arrival) {
  const bool is_first = last_arrival_ == Time::min();
  const Duration gap = is_first ? Duration{0} : arrival - last_arrival_;
  last_arrival_ = arrival;
  if (gap > kSettlingTime) settled_at_ = arrival + kSettlingTime;
  const Duration counted = std::clamp(gap, Duration{0}, kMaxCountedGap);
  useful_for_ += counted;
  useless_for_ += counted;
  if (useless_for_ > kMaxUselessGap) useful_for_ = Duration{0};
  if (dated && dated->uncertainty <= kMaxUncertainty) useless_for_ = Duration{0};
  if (useless_for_ >= kMaxUselessTime) is_by_arrival_ = true;
  if (is_by_arrival_ && useful_for_ >= kMinUsefulTime) is_by_arrival_ = false;
}

std::string describe(const SenderClock& clock) {
  switch (clock.kind()) {
    case SenderClockKind::kSteady:
      return "runs at the rate of this host's clock";
    case SenderClockKind::kScaled:
      return fmt::format(
          "runs at {:.2f} of the rate of this host's clock: frames are dated at this rate, within {:.0f} to "
          "{:.0f} ms",
          clock.rate(), to_seconds(ScaledSenderClock::kUncertainty) * 1e3,
          to_seconds(SenderClock::kMaxUncertainty) * 1e3);
    case SenderClockKind::kArrival:
      return fmt::format("is useless: frames are dated by their arrival, whose delay may vary by {:.0f} ms",
                         to_seconds(SenderClock::kArrivalUncertainty) * 1e3);
  }
  return "?";
}

}  // namespace sidestep
