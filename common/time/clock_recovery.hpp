// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>

#include "common/time/time.hpp"

namespace sidestep {

/// Decides whether a process adopts its host's clock. This is necessary if the host's clock was set correctly
/// only after the process had started. References are the processes whose clocks this process's clock must
/// agree with. Their time stamps are compared with both clocks: if a message arrives before it was sent, or
/// more than kMaxDelay later, the clocks disagree. The process keeps its clock while at least one reference
/// agrees with it: a step of the host's clock during a healthy run changes nothing.
class ClockRecovery {
 public:
  /// A smaller difference between the two clocks is ignored.
  static constexpr Duration kMinStep{10'000'000};
  /// Maximum difference of clocks that agree, beyond the network's delay and the clock bound.
  static constexpr Duration kTolerance{2'000'000};
  /// A message that seems older than this was not late; its sender's clock disagrees.
  static constexpr Duration kMaxDelay{250'000'000};
  /// Number of consecutive periods in which the evidence must be the same.
  static constexpr int kPeriods = 3;
  /// A reference counts in a period if it has sent at least this number of messages in it.
  static constexpr int kMinMessages = 3;
  /// Maximum number of references; others are ignored, because a hostile sender may invent any number.
  static constexpr std::size_t kMaxReferences = 2048;

  /// `max_clock_difference` is the maximum difference between two clocks that are within the clock bound.
  explicit ClockRecovery(Duration max_clock_difference = Duration{0})
      : tolerance_(kTolerance + max_clock_difference) {}

  /// Handles a message from a reference. `stamp_ns` is the reading of the sender's clock and may be any
  /// number; `now` is this process's time.
  void on_message(std::uint32_t reference, std::int64_t stamp_ns, Time now);
  /// Ends a period. `host_ahead` is the host's clock minus the process's clock. If `is_in_use`, other
  /// processes rely on this process's clock and the process keeps it. Returns whether the process adopts the
  /// host's clock.
  [[nodiscard]] bool end_period(Duration host_ahead, bool is_in_use);

 private:
  struct Reference {
    Duration min_age{Duration::max()};  ///< minimum time between a message's stamp and its arrival
    int messages = 0;
  };
  bool is_host_clock_right(Duration host_ahead) const;
  bool is_delay(Duration age) const { return age >= -tolerance_ && age <= kMaxDelay; }

  Duration tolerance_;
  std::map<std::uint32_t, Reference> references_;  ///< references heard in this period
  Duration last_host_ahead_{0};
  int evident_periods_ = 0;
};

}  // namespace sidestep
