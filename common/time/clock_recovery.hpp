// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>

#include "common/time/time.hpp"

namespace sidestep {

/// Decides whether a process adopts its host's clock, because that was set after the process had started and
/// only then became right. It compares the time stamps of those whose clocks this process's must agree with,
/// its references, with both clocks: a message that arrives before it was sent, or more than kMaxDelay
/// later, was sent by another clock. The process keeps its clock as long as one reference agrees with it: a
/// step of the host's clock during a healthy run changes nothing.
class ClockRecovery {
 public:
  /// A smaller difference between the two clocks is ignored.
  static constexpr Duration kMinStep{10'000'000};
  /// Clocks agree up to this difference, beside the network's delay and the clock bound.
  static constexpr Duration kTolerance{2'000'000};
  /// A message that seems to be older was sent by another clock, and is not merely late.
  static constexpr Duration kMaxDelay{250'000'000};
  /// The evidence must be the same in this number of periods in a row.
  static constexpr int kPeriods = 3;
  /// In each of them, a reference counts if it has sent at least this number of messages.
  static constexpr int kMinMessages = 3;
  /// References beyond this number are ignored: a hostile sender may invent any number.
  static constexpr std::size_t kMaxReferences = 2048;

  /// `max_clock_difference`: of two clocks that keep the clock bound.
  explicit ClockRecovery(Duration max_clock_difference = Duration{0})
      : tolerance_(kTolerance + max_clock_difference) {}

  /// A message of a reference. `stamp_ns` is its sender's clock and may be any number; `now` is the
  /// process's.
  void on_message(std::uint32_t reference, std::int64_t stamp_ns, Time now);
  /// Ends a period. `host_ahead`: the host's clock - the process's. `is_in_use`: the process works by its
  /// clock with others, and keeps it. Returns whether the process adopts the host's clock.
  [[nodiscard]] bool end_period(Duration host_ahead, bool is_in_use);

 private:
  struct Reference {
    Duration min_age{Duration::max()};  ///< least time between a message's stamp and its arrival
    int messages = 0;
  };
  bool is_evident(Duration host_ahead) const;
  bool is_delay(Duration age) const { return age >= -tolerance_ && age <= kMaxDelay; }

  Duration tolerance_;
  std::map<std::uint32_t, Reference> references_;  ///< of this period
  Duration last_host_ahead_{0};
  int evident_periods_ = 0;
};

}  // namespace sidestep
