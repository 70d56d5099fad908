// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "common/time/time.hpp"

namespace sidestep {

/// Guaranteed bounds on how far a peer's clock is ahead of the local clock.
struct OffsetInterval {
  Duration low{0};
  Duration high{0};

  Duration middle() const { return low + (high - low) / 2; }
  /// Half the width of the interval.
  Duration uncertainty() const { return (high - low + Duration{1}) / 2; }
  /// Whether every offset in the interval exceeds the bound in magnitude.
  bool is_beyond(Duration bound) const { return low > bound || high < -bound; }
  /// The offset in the interval with the smallest magnitude.
  Duration nearest_to_zero() const {
    return low > Duration{0} ? low : high < Duration{0} ? high : Duration{0};
  }
};

/// How far clock a is ahead of clock b, from the offsets of both against a third clock.
OffsetInterval difference(const OffsetInterval& a, const OffsetInterval& b);

/// The four timestamps of NTP: of a message to a peer, and of a later reply that says when the message
/// arrived. The peer may reply at any time after it has received the message.
struct ClockExchange {
  Time sent;           ///< by the local clock
  Time peer_received;  ///< by the peer's clock
  Time peer_sent;      ///< by the peer's clock
  Time received;       ///< by the local clock
};

/// Bounds the offset of a peer's clock from message exchanges. It relies only on causality (no message
/// arrives before it was sent), not on symmetric delays. Each exchange gives an interval, which widens with
/// time because clocks drift; the offset lies in the intersection. If the intersection is empty, a clock has
/// jumped, and only the newest exchange counts. Accepts arbitrary timestamps.
class ClockOffset {
 public:
  /// Maximum relative drift between two clocks: 50 ppm for each oscillator, plus the same amount for time
  /// daemons that slew them.
  static constexpr std::int64_t kDrift_ppm = 200;
  /// Longer exchanges are rejected because their intervals are too wide to be useful.
  static constexpr Duration kMaxExchangeDuration{10'000'000'000};

  /// Returns false for an invalid exchange: timestamps out of range or in an impossible order.
  bool add(const ClockExchange& exchange);
  /// Forgets all exchanges. Use it when the peer's clock changes.
  void reset() { *this = {}; }

  /// The interval at a time, widened by the drift since the last exchange. nullopt before the first exchange,
  /// and if the last exchange was received longer than `freshness` ago.
  std::optional<OffsetInterval> at(Time now, Duration freshness = Duration::max()) const;
  /// The number of clock jumps detected.
  std::uint64_t jumps() const { return jumps_; }

 private:
  std::optional<OffsetInterval> interval_;
  Time at_{};  // the time for which interval_ is valid
  Time newest_sent_{};
  std::uint64_t jumps_ = 0;
};

}  // namespace sidestep
