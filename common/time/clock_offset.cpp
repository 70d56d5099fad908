// SPDX-License-Identifier: Apache-2.0
#include "common/time/clock_offset.hpp"

#include <algorithm>

namespace sidestep {
namespace {

// The year 2043. Differences of two such times, and of two such differences, are far from where 64 bits end.
constexpr std::int64_t kLatest_ns = std::int64_t{1} << 61;
// Longer than any interval is of use, and far from where the product below ends.
constexpr Duration kLongestAge = std::chrono::hours(24);

bool is_time(Time t) { return to_ns(t) > 0 && to_ns(t) <= kLatest_ns; }

Duration drift(Duration age) {
  return std::clamp(age, Duration{0}, kLongestAge) * ClockOffset::kDrift_ppm / 1'000'000 + Duration{1};
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
  if (!is_time(e.sent) || !is_time(e.heard) || !is_time(e.answered) || !is_time(e.received)) return false;
  if (e.received < e.sent || e.received - e.sent > kLongestExchange || e.answered < e.heard) return false;
  const Time now = std::max(at_, e.received);
  const OffsetInterval latest{e.answered - e.received - drift(now - e.received),
                              e.heard - e.sent + drift(now - e.sent)};
  const bool is_overtaken = e.sent < newest_sent_;
  newest_sent_ = std::max(newest_sent_, e.sent);
  if (latest.low > latest.high) {
    // The other clock jumped between hearing and answering.
    if (is_overtaken) return true;
    ++jumps_;
    interval_.reset();
    return true;
  }
  const OffsetInterval before = interval_ ? widened(*interval_, now - at_) : latest;
  OffsetInterval both{std::max(before.low, latest.low), std::min(before.high, latest.high)};
  if (both.low > both.high) {
    // A message from before the jump may come after one from after it.
    if (is_overtaken) return true;
    ++jumps_;
    both = latest;
  }
  interval_ = both;
  at_ = now;
  return true;
}

std::optional<OffsetInterval> ClockOffset::at(Time now, Duration freshness) const {
  if (!interval_ || now - at_ > freshness) return std::nullopt;
  return widened(*interval_, now - at_);
}

}  // namespace sidestep
