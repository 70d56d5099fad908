// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/time/time.hpp"

namespace sidestep {

/// Whether the dates of a base's odometry can be believed. A report cannot arrive before it was measured. A
/// base whose clock is behind cannot be told from a slow connection. So dates are believed for kBeliefPeriod
/// after a report that arrived within `max_error` of its date, and none that is much older. What comes from
/// the future ends the belief.
class OdometryDates {
 public:
  static constexpr Duration kBeliefPeriod = std::chrono::milliseconds(500);
  /// Of `max_error`: a single report may be so late.
  static constexpr int kMaxLateness = 5;

  explicit OdometryDates(Duration max_error) : max_error_(max_error) {}

  /// Called once for each report, in the order of arrival.
  [[nodiscard]] bool is_believed(Time measured_at, Time arrived_at);

 private:
  Duration max_error_;
  std::optional<Time> proven_at_;
};

}  // namespace sidestep
