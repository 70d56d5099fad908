// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "common/time/time.hpp"

namespace sidestep {

/// How far another clock is ahead of one's own: between `low` and `high`, for sure.
struct OffsetInterval {
  Duration low{0};
  Duration high{0};

  Duration middle() const { return low + (high - low) / 2; }
  /// Give or take, about the middle.
  Duration uncertainty() const { return (high - low + Duration{1}) / 2; }
  /// No offset within the bound explains what was measured.
  bool is_beyond(Duration bound) const { return low > bound || high < -bound; }
  /// The least offset that explains what was measured.
  Duration nearest_to_zero() const {
    return low > Duration{0} ? low : high < Duration{0} ? high : Duration{0};
  }
};

/// How far clock a is ahead of clock b, both measured against a third.
OffsetInterval difference(const OffsetInterval& a, const OffsetInterval& b);

/// A message to somebody and something from there that tells when it came.
struct ClockExchange {
  Time sent;      ///< by one's own clock
  Time heard;     ///< by the other's,
  Time answered;  ///< and so is this: when it said so, as soon or as late as it liked
  Time received;  ///< by one's own
};

/// Bounds another clock's offset by exchanges of messages, without assuming that both ways take equally
/// long: nothing is heard before it was sent. Every exchange gives an interval, which widens as clocks drift
/// apart; the offset lies in all of them. When nothing lies in all of them, a clock has jumped, and only the
/// newest exchange still counts. Stamps from messages may be anything.
class ClockOffset {
 public:
  /// Two clocks drift apart by at most this: 50 ppm for each oscillator, and as much again for a time daemon
  /// that slews them.
  static constexpr std::int64_t kDrift_ppm = 200;
  /// Exchanges that took longer say nothing worth knowing.
  static constexpr Duration kLongestExchange{10'000'000'000};

  /// False when the exchange makes no sense: times out of range or in an impossible order.
  bool add(const ClockExchange& exchange);
  /// Forgets all: another clock is meant from now on.
  void reset() { *this = {}; }

  /// What is known at a time, widened for the time that has passed since the last exchange; nullopt before
  /// the first, and when the last was received longer than `freshness` ago.
  std::optional<OffsetInterval> at(Time now, Duration freshness = Duration::max()) const;
  /// Times that a clock was caught jumping.
  std::uint64_t jumps() const { return jumps_; }

 private:
  std::optional<OffsetInterval> interval_;
  Time at_{};  // what interval_ is true at
  Time newest_sent_{};
  std::uint64_t jumps_ = 0;
};

}  // namespace sidestep
