// SPDX-License-Identifier: Apache-2.0
#include "common/time/histogram.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

Duration DurationHistogram::upper_edge(std::size_t bucket) { return kEdges[bucket]; }

void DurationHistogram::add(Duration duration) {
  duration = std::max(duration, Duration{0});
  const auto edge = std::lower_bound(kEdges.begin(), kEdges.end() - 1, duration);
  ++buckets_[static_cast<std::size_t>(edge - kEdges.begin())];
  ++count_;
  largest_ = std::max(largest_, duration);
}

void DurationHistogram::merge(const DurationHistogram& other) {
  for (std::size_t i = 0; i < kBuckets; ++i) buckets_[i] += other.buckets_[i];
  count_ += other.count_;
  largest_ = std::max(largest_, other.largest_);
}

Duration DurationHistogram::quantile(double q) const {
  if (count_ == 0) return Duration{0};
  const double share = std::clamp(q, 0.0, 1.0) * static_cast<double>(count_);
  const auto rank = std::clamp<std::uint64_t>(static_cast<std::uint64_t>(std::ceil(share)), 1, count_);
  std::uint64_t below = 0;
  for (std::size_t i = 0; i + 1 < kBuckets; ++i) {
    below += buckets_[i];
    if (below >= rank) return std::min(kEdges[i], largest_);
  }
  return largest_;
}

void DurationHistogram::to_message(msg::DurationCounts& message) const {
  message.largest_ns(static_cast<std::uint64_t>(largest_.count()));
  for (std::size_t i = 0; i < kBuckets; ++i) {
    message.buckets()[i] = static_cast<std::uint32_t>(
        std::min<std::uint64_t>(buckets_[i], std::numeric_limits<std::uint32_t>::max()));
  }
}

DurationHistogram DurationHistogram::from_message(const msg::DurationCounts& message) {
  DurationHistogram histogram;
  constexpr std::uint64_t kMost = std::numeric_limits<Duration::rep>::max();
  histogram.largest_ =
      Duration{static_cast<Duration::rep>(std::min<std::uint64_t>(message.largest_ns(), kMost))};
  for (std::size_t i = 0; i < kBuckets; ++i) {
    histogram.buckets_[i] = message.buckets()[i];
    histogram.count_ += message.buckets()[i];
  }
  return histogram;
}

}  // namespace sidestep
