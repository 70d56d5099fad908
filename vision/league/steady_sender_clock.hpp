// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "common/time/time.hpp"
#include "vision/league/dated_capture.hpp"

namespace sidestep {

/// Converts times of a sender's clock, whose epoch is arbitrary, to the local clock, from one-way messages.
/// The lag of a message (arrival minus sending time) is the clock offset plus a delay. The minimum lag over
/// the last two seconds in which messages arrived is the offset plus the minimum delay. A drift of 200 ppm
/// causes an error of 0.4 ms, and delayed messages have no effect if at least one message in two seconds is
/// on time. The sender's clock must run at the rate of the local clock; SenderClock checks it.
class SteadySenderClock {
 public:
  /// A message with a longer apparent delay is useless, or shows that the sender's clock has been set.
  static constexpr Duration kMaxDelay{500'000'000};
  /// A lag below the minimum by more than this is accepted only after further messages agree with it.
  static constexpr Duration kMaxAhead{50'000'000};

  /// Uncertainty of the date of a message that is on time: drift, and the delay of the fastest message.
  static constexpr Duration kUncertainty{1'000'000};

  /// Initial time without output, because a process that was suspended receives old messages in one burst.
  static constexpr Duration kSettlingTime{100'000'000};

  /// The local time of a frame's capture. `captured` and `sent` are by the sender's clock, and `sent` is at
  /// most kMaxDelay after `captured`. The uncertainty is kUncertainty plus how late the message is, because a
  /// sender that has just become slower sends messages that look late. nullopt within kSettlingTime of the
  /// first message, for a message delayed by more than kMaxDelay, and for a message that contradicts earlier
  /// ones. A clock that was set forward is accepted after 5 consecutive messages that agree. A clock that was
  /// set back is accepted after 1 s of such messages, because a suspended process receives late messages only
  /// for a short time.
  [[nodiscard]] std::optional<DatedCapture> add(Duration captured, Duration sent, Time arrival);

  /// Whether the latest message agreed with earlier ones, or its jump was accepted.
  bool is_consistent() const { return disagreement_.count == 0; }
  /// Number of jumps detected in the sender's clock.
  std::uint64_t jumps() const { return jumps_; }

 private:
  static constexpr Duration kWindowPart{250'000'000};
  static constexpr std::size_t kWindowParts = 8;
  static constexpr int kMinAgreeing = 5;
  static constexpr Duration kMinAgreementTime{1'000'000'000};

  /// Consecutive messages that contradict the estimate and agree with each other.
  struct Disagreement {
    Duration min_lag{0};
    Time since{};
    int count = 0;
  };

  Duration min_lag() const;
  void reset(Duration lag, Time arrival);
  void update(Duration lag, Time arrival);
  bool confirms_jump(Duration lag, Time arrival, bool is_forward);

  std::array<Duration, kWindowParts> min_lags_{};  ///< of each part of the window, newest first
  std::size_t parts_ = 0;                          ///< number of parts in use
  Time part_since_{};
  Time settled_at_{};
  Disagreement disagreement_;
  std::uint64_t jumps_ = 0;
};

}  // namespace sidestep
