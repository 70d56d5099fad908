// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>

#include "common/geometry/vec2.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// The fastest turn of a robot whose heading is observed from time to time, averaged over kInterval.
class TurnRate {
 public:
  static constexpr Duration kInterval = std::chrono::milliseconds(200);

  /// Observations that are not later than the one before are ignored.
  void add(Time at, double heading_rad) {
    if (!seen_.empty() && at <= seen_.back().at) return;
    seen_.push_back({at, heading_rad});
    while (seen_.size() > 2 && at - seen_[1].at >= kInterval) seen_.pop_front();
    const Duration interval = at - seen_.front().at;
    if (interval < kInterval) return;
    const double rate_radps =
        std::abs(wrapped_rad(heading_rad - seen_.front().heading_rad)) / to_seconds(interval);
    fastest_radps_ = std::max(fastest_radps_.value_or(0), rate_radps);
  }
  /// nullopt: too few observations.
  const std::optional<double>& fastest_radps() const { return fastest_radps_; }

 private:
  struct Seen {
    Time at;
    double heading_rad;
  };
  std::deque<Seen> seen_;
  std::optional<double> fastest_radps_;
};

}  // namespace sidestep
