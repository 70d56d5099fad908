// SPDX-License-Identifier: Apache-2.0
#include "common/time/histogram.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sidestep {
namespace {

using Edges = std::array<Duration, DurationHistogram::kBuckets>;

const Edges kEdges = [] {
  Edges edges;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    edges[i] = Duration{std::llround(1000 * std::exp2(static_cast<double>(i) / 6))};
  }
  return edges;
}();

}  // namespace

DurationHistogram::DurationHistogram(const Buckets& buckets, Duration max)
    : buckets_(buckets),
      count_(std::accumulate(buckets.begin(), buckets.end(), std::uint64_t{0})),
      max_(max) {}

Duration DurationHistogram::upper_edge(std::size_t bucket) { return kEdges[bucket]; }

void DurationHistogram::add(Duration duration) {
  duration = std::max(duration, Duration{0});
  const auto edge = std::lower_bound(kEdges.begin(), kEdges.end() - 1, duration);
  ++buckets_[static_cast<std::size_t>(edge - kEdges.begin())];
  ++count_;
  max_ = std::max(max_, duration);
}

void DurationHistogram::merge(const DurationHistogram& other) {
  for (std::size_t i = 0; i < kBuckets; ++i) buckets_[i] += other.buckets_[i];
  count_ += other.count_;
  max_ = std::max(max_, other.max_);
}

Duration DurationHistogram::quantile(double q) const {
  if (count_ == 0) return Duration{0};
  const double target = std::clamp(q, 0.0, 1.0) * static_cast<double>(count_);
  const auto rank = std::clamp<std::uint64_t>(static_cast<std::uint64_t>(std::ceil(target)), 1, count_);
  std::uint64_t cumulative = 0;
  for (std::size_t i = 0; i + 1 < kBuckets; ++i) {
    cumulative += buckets_[i];
    if (cumulative >= rank) return std::min(kEdges[i], max_);
  }
  return max_;
}

}  // namespace sidestep
