// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>

namespace sidestep {

/// The part of the tracking bound that drift may use until the next observation. A robot that is farther from
/// its reference must return within 25 ms; the rest of the bound covers the motion during this time.
constexpr double drift_bound_m(double tracking_bound_m) { return 0.6 * tracking_bound_m; }

/// Maximum persistent error of the position that vision reports for a robot, for example due to a badly
/// calibrated camera. It is the part of the tracking bound that is not reserved for drift.
constexpr double vision_error_bound_m(double tracking_bound_m) {
  return tracking_bound_m - drift_bound_m(tracking_bound_m);
}

/// The errors that the margin between two robots has to cover; derived in coordinator/PROTOCOL.md.
struct SafetyBudget {
  double tracking_bound_m = 0.005;  ///< maximum distance between a robot and its reference
  double clock_bound_s = 0.0005;    ///< maximum offset between a robot's clock and the coordinator's
  double speed_mps = 2;             ///< maximum speed of a robot

  /// Both robots have a tracking error. Their clocks differ by up to twice the clock bound while they
  /// approach each other at up to twice the maximum speed.
  constexpr double required_margin_m() const {
    return 2 * tracking_bound_m + 2 * clock_bound_s * 2 * speed_mps;
  }
  /// The maximum speed of a robot whose clock is off by up to `offset_s` from the coordinator's: at this
  /// speed it uses up its half of the margin's allowance for clocks. Infinite for an offset of 0. A margin
  /// below the required one, which only studies use, counts as the required one.
  constexpr double max_speed_mps(double margin_m, double offset_s) const {
    return (std::max(margin_m, required_margin_m()) / 2 - tracking_bound_m) / offset_s;
  }
};

/// One line that shows how the margin is composed. Programs print it at start.
std::string budget_line(const SafetyBudget& budget, double margin_m);

}  // namespace sidestep
