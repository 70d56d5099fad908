// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/time/time.hpp"

namespace sidestep {

/// Decides whether the timestamps of a base's odometry can be trusted. A report cannot arrive before it was
/// measured. But a slow clock in the base cannot be distinguished from a slow connection. So timestamps are
/// trusted for kTrustPeriod after a report that arrived within `max_error` of its timestamp. A report that
/// arrives much later than its timestamp is never trusted, and a timestamp in the future ends the trust.
class OdometryTimestampCheck {
 public:
  static constexpr Duration kTrustPeriod = std::chrono::milliseconds(500);
  /// Multiple of `max_error` by which a single report may be late.
  static constexpr int kMaxLateness = 5;

  explicit OdometryTimestampCheck(Duration max_error) : max_error_(max_error) {}

  /// Whether the report's timestamp is trusted. Call it once for each report, in order of arrival.
  [[nodiscard]] bool admit(Time measured_at, Time arrived_at);

 private:
  Duration max_error_;
  std::optional<Time> trusted_at_;
};

}  // namespace sidestep
