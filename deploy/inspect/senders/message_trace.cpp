// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/senders/message_trace.hpp"

#include <algorithm>

#include "deploy/inspect/time_range.hpp"

namespace sidestep {
namespace {

constexpr std::int64_t kWindow = 64;
// Maximum relative drift of two hosts' clocks, in nanoseconds per second.
constexpr std::int64_t kMaxDrift_nsps = 200'000;

}  // namespace

Reception MessageTrace::record(std::uint64_t channel, const msg::Header& header, Time now) {
  ++received_;
  if (streams_.size() >= kMaxStreams) streams_.clear();
  auto [entry, is_new] = streams_.try_emplace({channel, header.incarnation(), header.sender()});
  Stream& stream = entry->second;
  const std::uint64_t number = header.message_number();
  const std::int64_t now_ns = to_ns(now);
  const std::int64_t stamp_ns = std::clamp<std::int64_t>(header.stamp_ns(), 0, kMaxTime_ns);

  Reception reception;
  if (is_new) {
    // Messages before the first one are neither received nor missed.
    stream = {number, ~std::uint64_t{0}, now_ns - stamp_ns, now_ns, 0};
    reception.is_newest = true;
    reception.is_next = number == 1;
    reception.missed = number > 0 ? number - 1 : 0;
    ++distinct_;
  } else if (number > stream.newest) {
    const std::uint64_t ahead = number - stream.newest;
    reception.is_newest = true;
    reception.is_next = ahead == 1;
    reception.missed = ahead - 1;
    missed_ += ahead - 1;
    ++distinct_;
    stream.window = ahead < kWindow ? stream.window << ahead | 1 : 1;
    stream.newest = number;
  } else if (const std::uint64_t back = stream.newest - number; back < kWindow) {
    const std::uint64_t bit = std::uint64_t{1} << back;
    if (!(stream.window & bit)) {
      --missed_;
      ++distinct_;
    }
    stream.window |= bit;
  }
  bound(stream, stamp_ns, now_ns, reception);
  return reception;
}

void MessageTrace::bound(Stream& stream, std::int64_t stamp_ns, std::int64_t now_ns,
                         Reception& reception) const {
  if (min_latency_bound_ns_ == 0) {
    reception.earliest_ns = reception.latest_ns = now_ns;
    return;
  }
  const std::int64_t passed_ms =
      std::clamp<std::int64_t>((now_ns - stream.updated_ns) / 1'000'000, 0, 1 << 20);
  stream.min_difference_ns =
      std::min(stream.min_difference_ns + passed_ms * kMaxDrift_nsps / 1000, now_ns - stamp_ns);
  stream.updated_ns = now_ns;
  // received - stamp = clock offset + latency, so its minimum is the clock offset + the minimum latency.
  reception.latest_ns = stamp_ns + stream.min_difference_ns;
  if (stream.count < kMinSamples) {
    ++stream.count;
  } else {
    reception.earliest_ns = reception.latest_ns - min_latency_bound_ns_;
  }
}

}  // namespace sidestep
