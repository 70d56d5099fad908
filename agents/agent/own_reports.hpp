// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/protocol/robot_messages.hpp"

namespace sidestep {

/// A robot's reports about itself: its estimate of its own state, how far it may rely on that estimate, and
/// how often it has stopped because it was off its reference. Input: the robot's reports.
class OwnReports {
 public:
  /// `start` is the robot's state before its first report. `drift_bound_m` is the maximum permitted
  /// difference between its estimate and its true position (drift_bound_m() of the scenario).
  OwnReports(const State& start, double drift_bound_m) : drift_bound_m_(drift_bound_m), estimate_(start) {}

  void on_robot_report(const RobotReport& robot_report);

  /// The robot's own estimate of its state.
  const State& estimate() const { return estimate_; }
  /// The distance that the robot may drive beyond a position ahead of it without being observed again. It
  /// must come to rest before its drift exceeds the tracking bound.
  double dead_reckoning_m(const Vec2& from_m) const;
  /// Whether the estimate is close enough to an observed position. The robot may not have received the
  /// observation yet.
  bool agrees_with(const Vec2& observed_m) const;
  /// Whether the robot has executed a granted version.
  bool has_moved() const { return has_moved_; }
  /// Number of times that the robot has stopped because it was off its reference.
  std::uint64_t reference_losses() const { return reference_losses_; }

 private:
  double drift_bound_m_;
  State estimate_;
  double max_dead_reckoning_m_ = 0;  // how far the robot may drive from estimate_ without being observed
  bool has_moved_ = false;
  std::uint64_t reference_losses_ = 0;
  VersionNumber last_own_stop_ = 0;  // newest of the stops that reference_losses_ counts
};

}  // namespace sidestep
