// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "common/time/time.hpp"

namespace sidestep {

/// Counts durations in logarithmic buckets, six per doubling, so a quantile is accurate to 12 %. Bucket i
/// covers durations above edge i - 1 and up to edge i = 1 us * 2^(i/6); the first covers everything below,
/// the last (2.1 s) everything above. Does not allocate.
class DurationHistogram {
 public:
  static constexpr std::size_t kBuckets = 128;
  using Buckets = std::array<std::uint64_t, kBuckets>;

  DurationHistogram() = default;
  /// Creates a histogram that was recorded elsewhere, from the count of each bucket and the maximum duration.
  DurationHistogram(const Buckets& buckets, Duration max);

  /// Negative durations count as zero.
  void add(Duration duration);
  void merge(const DurationHistogram& other);

  std::uint64_t count() const { return count_; }
  Duration max() const { return max_; }
  const Buckets& buckets() const { return buckets_; }
  /// The upper edge of the bucket that contains the quantile q (0 .. 1), but at most max(). Zero for an empty
  /// histogram.
  Duration quantile(double q) const;

  static Duration upper_edge(std::size_t bucket);

 private:
  Buckets buckets_{};
  std::uint64_t count_ = 0;
  Duration max_{0};
};

}  // namespace sidestep
