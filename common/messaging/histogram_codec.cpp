// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/histogram_codec.hpp"

#include <algorithm>
#include <limits>

namespace sidestep {

static_assert(DurationHistogram::kBuckets == msg::HISTOGRAM_BUCKETS);

msg::DurationCounts encode(const DurationHistogram& histogram) {
  msg::DurationCounts message;
  message.max_ns(static_cast<std::uint64_t>(histogram.max().count()));
  std::ranges::transform(histogram.buckets(), message.buckets().begin(), [](std::uint64_t count) {
    return static_cast<std::uint32_t>(
        std::min<std::uint64_t>(count, std::numeric_limits<std::uint32_t>::max()));
  });
  return message;
}

DurationHistogram decode(const msg::DurationCounts& message) {
  constexpr std::uint64_t kMaxDuration_ns = std::numeric_limits<Duration::rep>::max();
  DurationHistogram::Buckets buckets{};
  std::ranges::copy(message.buckets(), buckets.begin());
  return {buckets, Duration{static_cast<Duration::rep>(std::min(message.max_ns(), kMaxDuration_ns))}};
}

}  // namespace sidestep
