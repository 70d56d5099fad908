// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>

#include "common/time/time.hpp"

namespace sidestep {

/// Seconds since 1970 as used in JSON, accurate to a microsecond.
inline double unix_seconds(Time time) { return static_cast<double>(to_ns(time)) * 1e-9; }

/// Seconds since 1970 as a time; nullopt if they are out of range.
inline std::optional<Time> time_at(double at_s) {
  if (!(std::abs(at_s) <= 9e9)) return std::nullopt;
  return time_from_ns(std::llround(at_s * 1e9));
}

}  // namespace sidestep
