// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace sidestep {

/// How many robots of a run have arrived, of those that have a goal.
struct Arrivals {
  int robots = 0;
  int arrived = 0;
  int without_goal = 0;  ///< number of robots at rest with nothing to arrive at

  int with_goal() const { return robots - without_goal; }
  bool are_complete() const { return arrived >= with_goal(); }
};

/// "5 of 5 robots arrived and 3 had no goal". `when`, for example " in 3.01 s", follows "arrived".
[[nodiscard]] std::string arrivals_text(const Arrivals& arrivals, const std::string& when = {});

}  // namespace sidestep
