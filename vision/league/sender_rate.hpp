// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "common/time/time.hpp"

namespace sidestep {

/// Measures the rate of a sender's clock from one-way messages: the sender's seconds per local second. The
/// fastest messages at both ends of a window determine it, so delayed messages have no effect if at least one
/// message in each end is on time. A simulator's rate is that of its simulated time, and may change.
class SenderRate {
 public:
  /// The measured rate has these bounds; a clock with another rate is useless.
  static constexpr double kMinRate = 0.4, kMaxRate = 1.1;

  /// Handles a message that agrees with earlier ones. `sent` is by the sender's clock.
  void add(Duration sent, Time arrival);
  void reset();
  /// The rate over the last half second. nullopt if too few messages arrived, or the rate is out of bounds.
  /// Rates within 0.4 % of 1 are reported as 1, because the measurement is not more accurate.
  std::optional<double> rate() const;
  /// By how much the sender's clock has fallen behind the local clock over the last two seconds, or less if
  /// messages began to arrive later. nullopt if too few messages arrived.
  std::optional<Duration> fallen_behind() const;
  /// Whether two seconds of messages show a clock with the local clock's rate.
  bool is_steady() const;

 private:
  static constexpr Duration kPart{50'000'000};
  static constexpr std::size_t kParts = 40;        ///< two seconds
  static constexpr std::size_t kPartsOfRate = 10;  ///< half a second
  static constexpr std::size_t kPartsOfEnd = 3;

  /// The fastest message of a part of the window.
  struct Message {
    Duration sent{0};
    Time arrival{};
    Duration lag() const { return arrival.time_since_epoch() - sent; }
  };
  /// A closed part; 0 is the newest.
  const Message& part(std::size_t age) const { return parts_[(next_ + kParts - 1 - age) % kParts]; }
  /// The message with the smallest lag in the end of the window that begins with part `age`.
  const Message& fastest(std::size_t age) const;

  std::array<Message, kParts> parts_{};  ///< ring buffer of closed parts
  std::size_t next_ = 0, count_ = 0;
  std::optional<Message> open_;  ///< the part that is being filled
  Time open_since_{};
};

}  // namespace sidestep
