// SPDX-License-Identifier: Apache-2.0
#include "deploy/monitor/audit/message_trace.hpp"

#include <algorithm>

namespace sidestep {
namespace {

constexpr std::int64_t kWindow = 64;
// How fast two hosts' clocks may part, in nanoseconds a second.
constexpr std::int64_t kDrift_nsps = 200'000;
constexpr std::int64_t kLatest_ns = std::int64_t{1} << 62;

}  // namespace

Heard MessageTrace::note(std::uint64_t channel, const msg::Header& head, Time now) {
  ++heard_;
  if (streams_.size() >= kMostStreams) streams_.clear();
  auto [at, is_new] = streams_.try_emplace({channel, head.incarnation(), head.sender()});
  Stream& stream = at->second;
  const std::uint64_t number = head.message_number();
  const std::int64_t now_ns = to_ns(now);
  const std::int64_t stamp_ns = std::clamp<std::int64_t>(head.stamp_ns(), 0, kLatest_ns);

  Heard heard;
  if (is_new) {
    stream = {number, 1, now_ns - stamp_ns, now_ns, 0};
    heard.is_newest = true;
    heard.is_next = number == 1;
  } else if (number > stream.newest) {
    const std::uint64_t ahead = number - stream.newest;
    heard.is_newest = true;
    heard.is_next = ahead == 1;
    missed_ += ahead - 1;
    stream.window = ahead < kWindow ? stream.window << ahead | 1 : 1;
    stream.newest = number;
  } else if (const std::uint64_t back = stream.newest - number; back < kWindow) {
    const std::uint64_t bit = std::uint64_t{1} << back;
    if (!(stream.window & bit) && missed_ > 0) --missed_;
    stream.window |= bit;
  }
  bound(stream, stamp_ns, now_ns, heard);
  return heard;
}

void MessageTrace::bound(Stream& stream, std::int64_t stamp_ns, std::int64_t now_ns, Heard& heard) const {
  if (fastest_ns_ == 0) {
    heard.earliest_ns = heard.latest_ns = now_ns;
    return;
  }
  const std::int64_t passed_ms = std::clamp<std::int64_t>((now_ns - stream.at_ns) / 1'000'000, 0, 1 << 20);
  stream.least_ahead_ns = std::min(stream.least_ahead_ns + passed_ms * kDrift_nsps / 1000, now_ns - stamp_ns);
  stream.at_ns = now_ns;
  // heard - stamp = clocks' difference + the way; its least is the difference + the fastest way.
  heard.latest_ns = stamp_ns + stream.least_ahead_ns;
  if (stream.count < kEnough) {
    ++stream.count;
  } else {
    heard.earliest_ns = heard.latest_ns - fastest_ns_;
  }
}

}  // namespace sidestep
