// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "common/time/time.hpp"

namespace sidestep {

/// Maps times of a sender's clock, whose zero is anywhere, to one's own from messages that come one way only.
/// A message's arrival is later than its sending by the offset between the clocks and a delay; the least of
/// these sums is the offset but for the least delay. It is taken over the last two seconds in which messages
/// came, so clocks may drift by 200 ppm for an error of 0.4 ms, and a delayed message changes nothing as long
/// as one in two seconds is on time. The sender's clock has to run as fast as one's own.
class SenderClock {
 public:
  /// Beyond this a message is of no use any more, or the clock was set.
  static constexpr Duration kMostDelay{500'000'000};
  /// A sum that is less by more than this is not believed before others agree.
  static constexpr Duration kMostAhead{50'000'000};

  /// For so long a sender is only listened to: who was held up finds its first messages all at once, and old.
  static constexpr Duration kSettling{100'000'000};

  /// When a frame was captured, by one's own clock. `captured` and `sent` are by the sender's; a `sent` that
  /// is before `captured` or more than kMostDelay after it is of another clock and not used. Nothing within
  /// kSettling of the first message, for a message that came more than kMostDelay late, or that contradicts
  /// those before: a clock that was set ahead is believed after 5 messages in a row that agree, one that was
  /// set back after a second of them, since a process that was held up finds late messages only for a while.
  std::optional<Time> add(Duration captured, Duration sent, Time arrival);

  /// Times that the sender's clock was found to have been set.
  std::uint64_t jumps() const { return jumps_; }

 private:
  static constexpr Duration kPart{250'000'000};
  static constexpr std::size_t kParts = 8;
  static constexpr int kAgreeing = 5;
  static constexpr Duration kAgreeingFor{1'000'000'000};

  /// Messages in a row that contradict the estimate and agree with each other.
  struct Doubt {
    Duration least{0};
    Time since{};
    int count = 0;
  };

  Duration least() const;
  void begin(Duration lag, Time arrival);
  void note(Duration lag, Time arrival);
  bool is_jump(Duration lag, Time arrival, bool is_ahead);

  std::array<Duration, kParts> least_{};  ///< of each part of the window, the newest first
  std::size_t parts_ = 0;                 ///< in use
  Time part_since_{};
  Time settled_at_{};
  Doubt doubt_;
  std::uint64_t jumps_ = 0;
};

}  // namespace sidestep
