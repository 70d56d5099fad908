// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "common/time/time.hpp"
#include "idl/monitor.h"

namespace sidestep {

/// Counts durations in logarithmic buckets, six to each doubling, so a quantile is right to 12 %. Bucket i
/// holds what is above edge i - 1 and at most edge i = 1 us * 2^(i/6); the first takes everything below, the
/// last (2.1 s) everything above. Allocates nothing.
class DurationHistogram {
 public:
  static constexpr std::size_t kBuckets = msg::HISTOGRAM_BUCKETS;

  /// Negative durations count as zero.
  void add(Duration duration);
  void merge(const DurationHistogram& other);

  std::uint64_t count() const { return count_; }
  Duration largest() const { return largest_; }
  /// Upper edge of the bucket in which the share q (0 .. 1) of all durations is reached, and at most the
  /// largest duration; zero when nothing was counted.
  Duration quantile(double q) const;

  /// Counts beyond 32 bits stay at the highest that the message holds.
  void to_message(msg::DurationCounts& message) const;
  static DurationHistogram from_message(const msg::DurationCounts& message);

  static Duration upper_edge(std::size_t bucket);

 private:
  std::array<std::uint64_t, kBuckets> buckets_{};
  std::uint64_t count_ = 0;
  Duration largest_{0};
};

}  // namespace sidestep
