// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace sidestep {

/// What a margin between two robots has to make up for (safety-protocol.md, "What it assumes"; derived in
/// coordinator/PROTOCOL.md).
struct SafetyBudget {
  double tracking_bound_m = 0.003;  ///< a robot on its reference is nearer to it than this
  double clock_bound_s = 0.0005;    ///< no robot's clock differs from the coordinator's by more than this
  double speed_mps = 2;             ///< no robot is faster than this

  /// Each robot is off by its tracking error, and two clocks may differ by twice the bound while the robots
  /// approach each other at twice the speed.
  constexpr double needed_margin_m() const {
    return 2 * tracking_bound_m + 2 * clock_bound_s * 2 * speed_mps;
  }
};

/// One line for people, what the margin is made of; programs print it when they begin to run a scenario.
std::string budget_line(const SafetyBudget& budget, double margin_m);

}  // namespace sidestep
