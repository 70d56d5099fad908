// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

namespace sidestep {

/// The clock of the system, in nanoseconds since 1970: the process's clock when running over DDS
/// (EventLoop::now()), or virtual time on SimBus.
struct Clock {
  using duration = std::chrono::nanoseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<Clock>;
  static constexpr bool is_steady = false;
};

using Duration = Clock::duration;
using Time = Clock::time_point;

constexpr Time time_from_ns(std::int64_t ns) { return Time{Duration{ns}}; }
constexpr std::int64_t to_ns(Time t) { return t.time_since_epoch().count(); }

/// The latest time that is accepted from messages and files, in the year 2116; the earliest is 0. Differences
/// between two such times, and between two such differences, fit into 64 bits, even if each is off by a
/// quarter of an hour.
inline constexpr Time kMaxTime = time_from_ns((std::int64_t{1} << 62) - (std::int64_t{1} << 41));

/// Rounds to the nearest nanosecond. Precondition: the number of nanoseconds fits into 64 bits.
constexpr Duration from_seconds(double s) {
  return Duration{static_cast<std::int64_t>(s * 1e9 + (s < 0 ? -0.5 : 0.5))};
}
constexpr double to_seconds(Duration d) { return static_cast<double>(d.count()) * 1e-9; }

}  // namespace sidestep
