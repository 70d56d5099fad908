// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/time/time.hpp"
#include "vision/league/dated_capture.hpp"
#include "vision/league/scaled_sender_clock.hpp"
#include "vision/league/sender_rate.hpp"
#include "vision/league/steady_sender_clock.hpp"

namespace sidestep {

/// How times of a sender are converted to the local clock.
enum class SenderClockKind : std::uint8_t {
  kSteady,   ///< the sender's clock has the local clock's rate
  kScaled,   ///< it has another rate, which is measured
  kArrival,  ///< its times are useless: frames are dated by their arrival
};

/// Converts times of a sender's clock to the local clock, from one-way messages. The epoch of the sender's
/// clock is arbitrary and its rate may be that of a simulation.
class SenderClock {
 public:
  /// Dates that are less certain are not to be used.
  static constexpr Duration kMaxUncertainty{15'000'000};
  /// Uncertainty of a date by arrival. A constant delay is part of the latency that conformance measures, so
  /// this covers only its variation.
  static constexpr Duration kArrivalUncertainty{15'000'000};
  /// A date is at most this much earlier than the arrival.
  static constexpr Duration kMaxAge = 2 * SteadySenderClock::kMaxDelay;
  /// Time without output at the beginning, and, if dates are arrivals, after a silence of the same length.
  static constexpr Duration kSettlingTime = SteadySenderClock::kSettlingTime;

  /// The local time of a frame's capture, never later than `arrival`. `captured` and `sent` are by the
  /// sender's clock; a `sent` before `captured` or more than 500 ms after it is from another clock and
  /// ignored. The true time is within the uncertainty if a message in 100 ms is on time; with kArrival, if
  /// the message's delay varies by no more. nullopt while the clock settles, and for a message that
  /// contradicts earlier ones.
  [[nodiscard]] std::optional<DatedCapture> add(Duration captured, Duration sent, Time arrival);

  SenderClockKind kind() const { return is_by_arrival_ ? SenderClockKind::kArrival : kind_; }
  /// The sender's seconds per local second; 1 unless kScaled.
  double rate() const { return kind() == SenderClockKind::kScaled ? rate_ : 1; }
  /// Number of jumps detected in the sender's clock.
  std::uint64_t jumps() const { return jumps_; }

 private:
  std::optional<DatedCapture> dated_by_sender(Duration captured, Duration sent, Time arrival);
  std::optional<DatedCapture> dated_steadily(Duration captured, Duration sent, Time arrival);
  std::optional<DatedCapture> dated_at_rate(Duration captured, Duration sent, Time arrival);
  void choose_rate(Time arrival);
  void judge(const std::optional<DatedCapture>& dated, Time arrival);

  SenderClockKind kind_ = SenderClockKind::kSteady;
  SteadySenderClock steady_;
  ScaledSenderClock scaled_;
  SenderRate measured_;
  double rate_ = 1;
  bool is_rate_known_ = true;
  std::optional<Time> steady_since_;  ///< since when a scaled clock has run steadily
  std::uint64_t jumps_ = 0;

  bool is_by_arrival_ = false;
  Time last_arrival_ = Time::min();
  Duration useless_for_{0};  ///< time in which messages arrived since the last usable date
  Duration useful_for_{0};   ///< the same, since the last long time without usable dates
  Time settled_at_{};        ///< from when on dates by arrival are given
};

/// What the clock is like and how frames are dated, for messages. It continues "the clock of sender S ".
std::string describe(const SenderClock& clock);

}  // namespace sidestep
