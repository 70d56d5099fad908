// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/time/time.hpp"
#include "vision/league/dated_capture.hpp"

namespace sidestep {

/// Converts times of a sender's clock that runs at another rate than the local clock, and does so unevenly,
/// as a simulator's does. A message was sent no later than any message of the last 100 ms predicts at the
/// given rate: the smallest prediction is the date, a lower envelope. A message that arrives after this date
/// either was delayed, or the sender has become slower. The date is then halfway between, and the uncertainty
/// covers both. Delays of all messages that last longer than 100 ms are taken for a slower sender.
class ScaledSenderClock {
 public:
  /// A message that seems later is useless, or the sender's clock has been set.
  static constexpr Duration kMaxDelay{500'000'000};
  /// A message that seems to arrive earlier by more than this shows that the sender's clock has been set.
  static constexpr Duration kMaxAhead{50'000'000};
  /// Uncertainty of the date of a message that is on time.
  static constexpr Duration kUncertainty{3'000'000};
  /// After a longer silence there is no output for kSettlingTime, because this process may have been
  /// suspended, and then receives old messages in a burst.
  static constexpr Duration kMaxSilence{60'000'000}, kSettlingTime{50'000'000};

  /// `sent` and `captured` are by the sender's clock, and `rate` is its seconds per local second. nullopt
  /// while settling, and for a message that contradicts earlier ones. Five that agree with each other are
  /// accepted as a jump.
  [[nodiscard]] std::optional<DatedCapture> add(Duration captured, Duration sent, Time arrival, double rate);
  void reset() { count_ = 0; }
  /// Whether the latest message agreed with earlier ones, or its jump was accepted.
  bool is_consistent() const { return contradictions_ == 0; }
  std::uint64_t jumps() const { return jumps_; }

 private:
  static constexpr Duration kWindow{100'000'000};
  static constexpr int kMinAgreeing = 5;
  struct Message {
    Duration sent{0};
    Time arrival{};
  };
  void keep(const Message& message);
  /// The earliest arrival that the messages of the window predict. nullopt if one is seconds away.
  std::optional<Time> predicted_arrival(const Message& message, double rate) const;
  bool confirms_jump(const Message& message);

  std::array<Message, 64> messages_{};  ///< ring buffer
  std::size_t next_ = 0, count_ = 0;
  Time last_arrival_{}, settled_at_{};
  Message contradicting_;
  int contradictions_ = 0;
  std::uint64_t jumps_ = 0;
};

}  // namespace sidestep
