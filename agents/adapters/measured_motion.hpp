// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "agents/adapters/driver.hpp"

namespace sidestep {

/// The velocities that a base has recently measured, computed from differences of its odometry.
class MeasuredMotion {
 public:
  /// Precondition: the report is finite and its timestamp is trusted.
  void add(const OdometryReport& report);
  /// The time of the latest report; Time{} before the first.
  Time until() const { return last_ ? last_->measured_at : Time{}; }
  /// The mean velocity from `from` to `to`; nullopt if the reports do not cover this interval or are no
  /// longer remembered. Precondition: from < to.
  std::optional<BodyVelocity> mean(Time from, Time to) const;

 private:
  struct Interval {
    Time from{}, to{};
    BodyVelocity velocity;
  };
  static constexpr std::size_t kRemembered = 64;

  std::optional<OdometryReport> last_;
  std::array<Interval, kRemembered> intervals_{};  ///< ring buffer
  std::size_t count_ = 0;
};

}  // namespace sidestep
