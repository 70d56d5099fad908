// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "common/time/time.hpp"

namespace sidestep {

/// The error of a simulated clock relative to true time: an offset at `since`, and a constant drift from then
/// on.
struct ClockError {
  Duration offset{0};    ///< positive: the clock is ahead
  double drift_ppm = 0;  ///< positive: the clock gains; at most 1000 in magnitude
  Time since{};

  /// The clock's reading at a true time.
  Time reading(Time true_time) const {
    if (drift_ppm == 0) return true_time + offset;
    return true_time + offset + part(true_time - since, drift_ppm * 1e-6);
  }
  /// The earliest true time, to the nanosecond, at which the clock shows at least this reading.
  Time true_time(Time shown) const {
    if (drift_ppm == 0) return shown - offset;
    const Duration elapsed = shown - offset - since;
    Time t = since + elapsed - part(elapsed, drift_ppm / (1e6 + drift_ppm));
    while (reading(t) < shown) t += Duration{1};
    while (reading(t - Duration{1}) >= shown) t -= Duration{1};
    return t;
  }

 private:
  static Duration part(Duration whole, double share) {
    return Duration{std::llround(static_cast<double>(whole.count()) * share)};
  }
};

}  // namespace sidestep
