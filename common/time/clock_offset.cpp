// SPDX-License-Identifier: Apache-2.0
#include "common/time/clock_offset.hpp"

#include <algorithm>

namespace sidestep {
namespace {

// Upper bound for ages, so that the product below does not overflow. At this age an interval is too wide to
// be useful.
constexpr Duration kMaxAge = std::chrono::hours(24);

bool is_time(Time t) { return to_ns(t) > 0 && t <= kMaxTime; }

Duration drift(Duration age) {
  return std::clamp(age, Duration{0}, kMaxAge) * ClockOffset::kDrift_ppm / 1'000'000 + Duration{1};
}

OffsetInterval widened(const OffsetInterval& interval, Duration age) {
  const Duration by = drift(age);
  return {interval.low - by, interval.high + by};
}

}  // namespace

OffsetInterval difference(const OffsetInterval& a, const OffsetInterval& b) {
  return {a.low - b.high, a.high - b.low};
}

bool ClockOffset::add(const ClockExchange& e) {
  if (!is_time(e.sent) || !is_time(e.peer_received) || !is_time(e.peer_sent) || !is_time(e.received))
    return false;
  if (e.received < e.sent || e.received - e.sent > kMaxExchangeDuration || e.peer_sent < e.peer_received)
    return false;
  const Time now = std::max(at_, e.received);
  const OffsetInterval latest{e.peer_sent - e.received - drift(now - e.received),
                              e.peer_received - e.sent + drift(now - e.sent)};
  const bool is_overtaken = e.sent < newest_sent_;
  newest_sent_ = std::max(newest_sent_, e.sent);
  if (latest.low > latest.high) {
    // The peer's clock jumped between its two timestamps.
    if (is_overtaken) return true;
    ++jumps_;
    interval_.reset();
    return true;
  }
  const OffsetInterval known = interval_ ? widened(*interval_, now - at_) : latest;
  OffsetInterval intersection{std::max(known.low, latest.low), std::min(known.high, latest.high)};
  if (intersection.low > intersection.high) {
    // A message sent before the jump may arrive after a message sent after it.
    if (is_overtaken) return true;
    ++jumps_;
    intersection = latest;
  }
  interval_ = intersection;
  at_ = now;
  return true;
}

std::optional<OffsetInterval> ClockOffset::at(Time now, Duration freshness) const {
  if (!interval_ || now - at_ > freshness) return std::nullopt;
  return widened(*interval_, now - at_);
}

}  // namespace sidestep
