// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/rate_meter.hpp"

#include <algorithm>

namespace sidestep {

void RateMeter::Span::add(Time received, std::size_t size) {
  ++samples;
  all_bytes += size;
  min_bytes = samples == 1 ? size : std::min(min_bytes, size);
  max_bytes = std::max(max_bytes, size);
  if (has_last) {
    const Duration gap = received - last;
    min_gap = std::min(min_gap, gap);
    max_gap = std::max(max_gap, gap);
    ++gaps;
    bytes += size;
  } else {
    first = received;
    has_last = true;
  }
  last = received;
}

Rate RateMeter::Span::rate() const {
  Rate result;
  result.samples = samples;
  result.min_bytes = min_bytes;
  result.max_bytes = max_bytes;
  if (samples > 0) result.mean_bytes = static_cast<double>(all_bytes) / static_cast<double>(samples);
  if (gaps == 0) return result;
  result.min_gap = min_gap;
  result.max_gap = max_gap;
  const double seconds = to_seconds(last - first);
  if (seconds > 0) {
    result.rate_hz = static_cast<double>(gaps) / seconds;
    result.bytes_per_second = static_cast<double>(bytes) / seconds;
  }
  return result;
}

void RateMeter::add(Time received, std::size_t bytes) {
  total_.add(received, bytes);
  recent_.add(received, bytes);
}

Rate RateMeter::take_recent() {
  const Rate result = recent_.rate();
  Span next;
  next.has_last = recent_.has_last;
  next.first = next.last = recent_.last;
  recent_ = next;
  return result;
}

}  // namespace sidestep
